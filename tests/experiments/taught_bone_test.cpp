// A bone that a second session drills along: over a simulated network, and in two processes.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/bone/data/bone_file.h"
#include "core/bone/record/drilling_tables.h"
#include "core/bone/record/recorded_bone.h"
#include "core/bone/record/tool_rows.h"
#include "core/bone/simulator/bone_touch.h"
#include "core/record/hdf5/session_writer.h"
#include "core/record/read/integrity.h"
#include "core/record/read/session_reader.h"
#include "core/record/rows/partner_rows.h"
#include "core/record/table/schema.h"
#include "protocols/bone_drilling/bone_replay.h"
#include "protocols/bone_drilling/definition/bone_definition.h"
#include "protocols/bone_drilling/drilling_pass.h"
#include "protocols/bone_drilling/load_bones.h"
#include "tests/experiments/command.h"
#include "tests/experiments/live_command.h"
#include "tests/experiments/network_relay.h"
#include "tests/experiments/shipped.h"
#include "tests/experiments/small_drilling.h"
#include "tests/support/free_port.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::taught_bone_test {
namespace {

namespace fs = std::filesystem;
using test::run_command;
using testing::ElementsAre;
using testing::HasSubstr;

std::vector<std::string> texts_of(const record::SessionReader& reader, const std::string& kind) {
  std::vector<std::string> texts;
  for (const record::EventRow& event : reader.events()) {
    if (event.kind == kind) {
      texts.push_back(event.text);
    }
  }
  return texts;
}

/// Checks that two files say the same of one bone, to the bit.
void expect_one_bone(const record::SessionReader& learns, const record::SessionReader& teaches) {
  for (const record::SessionReader* reader : {&learns, &teaches}) {
    const record::Integrity integrity = record::check_session(*reader);
    EXPECT_TRUE(integrity.ok) << testing::PrintToString(integrity.problems);
    EXPECT_EQ(integrity.dropped, 0u);
    EXPECT_THAT(texts_of(*reader, "bone_checked"), ElementsAre(HasSubstr("are the same after")));
    EXPECT_THAT(texts_of(*reader, "bone_differs"), testing::IsEmpty());
    const protocols::ReplayVerdict again = protocols::BoneReplay(reader->path()).run(1);
    EXPECT_EQ(again.difference, "");
    EXPECT_TRUE(again.whole);
  }
  EXPECT_EQ(texts_of(learns, "bone_checked"), texts_of(teaches, "bone_checked"));
  const auto own = learns.rows<record::ProcedureRow>();
  const auto other = teaches.rows<record::ProcedureRow>();
  ASSERT_EQ(own.size(), other.size());
  EXPECT_EQ(own.back().checksum, other.back().checksum);
  EXPECT_EQ(own.back().left, other.back().left);
  const auto followed = learns.rows<record::RemovalRow>();
  const auto removed = teaches.rows<record::RemovalRow>();
  ASSERT_EQ(followed.size(), removed.size());
  EXPECT_GT(removed.size(), 10u);
  for (std::size_t i = 0; i < removed.size(); ++i) {
    ASSERT_EQ(followed[i].voxel, removed[i].voxel) << i;
    ASSERT_EQ(followed[i].piece, removed[i].piece) << i;
    ASSERT_EQ(followed[i].label, removed[i].label) << i;
    ASSERT_NEAR(followed[i].force, removed[i].force, 1e-6) << i;
    ASSERT_EQ(followed[i].speed, removed[i].speed) << i;
  }
  EXPECT_EQ(learns.rows<record::SplitRow>().size(), teaches.rows<record::SplitRow>().size());
}

/// A hand that presses needs something of its own world to rest on.
constexpr const char* kBad =
    "authority = 0.5\n[tutoring.channel]\ndelay = 0.01\njitter = 0.002\nloss = 0.05\n"
    "duplication = 0.02\nreordering = 0.05\n";

class TaughtBoneTest : public testing::Test {
 protected:
  fs::path definition(const std::string& tutoring, double seconds = 8.0,
                      const std::vector<std::pair<std::string, std::string>>& more = {}) {
    const fs::path file = test::write_small_drilling(folder_.path(), seconds, more);
    test::write_text(file, test::read_text(file) + "\n[tutoring]\n" + tutoring);
    return file;
  }
  std::string taught(const fs::path& file, const std::string& name) {
    const std::string out = (folder_ / name).string();
    const test::CommandResult r =
        run_command("haptrial dry-run '" + file.string() + "' --subjects 1 --taught --out " + out);
    EXPECT_EQ(r.status, 0) << r.errors;
    return out;
  }
  test::TemporaryFolder folder_;
};

TEST_F(TaughtBoneTest, OverABadNetworkBothFilesHaveTheSameBoneAndSoHasTheNextRun) {
  const fs::path file = definition(kBad, 3.0);
  const std::string out = taught(file, "out");
  const record::SessionReader learns(out + "/S01.h5");
  expect_one_bone(learns, record::SessionReader(out + "/teaching/S01.h5"));
  const std::string again = taught(file, "again");
  const record::SessionReader same(again + "/S01.h5");
  const record::PassRow pass = learns.passes().at(0);
  const auto a = learns.rows<record::LedRow>();
  EXPECT_LT(pass.last_sample - a.back().sequence, 100u) << "checksums are compared at once";
  const auto b = same.rows<record::LedRow>();
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(a[i].sequence, b[i].sequence) << i;
    ASSERT_EQ(a[i].tool.position, b[i].tool.position) << i;
  }
  EXPECT_EQ(texts_of(learns, "link"), texts_of(same, "link"));
}

TEST_F(TaughtBoneTest, AReplayOfTheLedSessionGivesItsBone) {
  const std::string out = taught(definition("", 3.0), "out");
  const test::CommandResult r = run_command("haptrial replay " + out + "/S01.h5");
  EXPECT_EQ(r.status, 0) << r.errors;
  EXPECT_THAT(r.output, HasSubstr("trial 1: the same bone"));
}

/// A copy of a led session in which the rows of /handpiece on some ticks are others.
fs::path with_another_handpiece(const record::SessionReader& reader, const fs::path& copy,
                                std::uint64_t from, const record::HandpieceRow& other) {
  auto held = reader.rows<record::HandpieceRow>();
  for (record::HandpieceRow& row : held) {
    const std::uint64_t sequence = row.sequence;
    if (sequence >= from && sequence < from + 20) {
      row = other;
      row.sequence = sequence;
    }
  }
  record::TableList tables = record::drilling_tables();
  tables.push_back(&record::table_of<record::LedRow>());
  tables.push_back(&record::table_of<record::HandpieceRow>());
  record::SessionWriter writer(copy, reader.info(), tables,
                               record::rows_of(record::recorded_bones(reader)));
  writer.add(std::span<const record::ToolRow>(reader.rows<record::ToolRow>()));
  writer.add(std::span<const record::HandpieceRow>(held));
  writer.add(std::span<const record::LedRow>(reader.rows<record::LedRow>()));
  writer.add(std::span<const record::RemovalRow>(reader.rows<record::RemovalRow>()));
  writer.add(std::span<const record::SplitRow>(reader.rows<record::SplitRow>()));
  writer.add(std::span<const record::ProcedureRow>(reader.rows<record::ProcedureRow>()));
  writer.append(reader.samples(0, reader.sample_count()));
  writer.add_pass(reader.passes().front());
  writer.close();
  return copy;
}

TEST_F(TaughtBoneTest, AReplayOfTheLedSessionFeelsItsHandpiece) {
  const std::string burr =
      "diameter = 0.006\nwear_volume = 1e-8\nshaft_radius = 0.003\n"
      "shaft_length = 0.02";
  const std::string out = taught(definition("", 4.0, {{"diameter", burr}}), "out");
  const record::SessionReader reader(out + "/S01.h5");
  const auto held = reader.rows<record::HandpieceRow>();
  ASSERT_EQ(held.size(), reader.sample_count());
  const record::HandpieceRow worn =
      *std::ranges::min_element(held, {}, &record::HandpieceRow::sharpness);
  ASSERT_LT(worn.sharpness, 0.95) << "the burr wears";
  const protocols::ReplayVerdict same = protocols::BoneReplay(reader.path()).run(1);
  EXPECT_EQ(same.difference, "");
  const std::uint64_t when = worn.sequence;
  record::HandpieceRow other = worn;
  other.sharpness *= 0.5;
  const auto blunt = with_another_handpiece(reader, folder_ / "blunt.h5", when, other);
  EXPECT_THAT(protocols::BoneReplay(blunt).run(1).difference,
              HasSubstr("on tick " + std::to_string(when) + " the record has a burr of sharpness"));
  other = worn;
  other.shaft.x() += 1.0;
  const auto pushed = with_another_handpiece(reader, folder_ / "pushed.h5", when, other);
  EXPECT_THAT(protocols::BoneReplay(pushed).run(1).difference, HasSubstr("on the burr's shaft"));
}

/// Forces on a hand from a bone that it did not drill itself follow from the bone that the replay
/// makes: to the last bit of the file.
TEST_F(TaughtBoneTest, WhatTheLedHandFeltFollowsFromTheFile) {
  const fs::path study =
      definition("authority = 0.5\n", 8.0, {{"bones", "bones = [\"dura.nrrd\"]"}});
  test::write_text(study, test::read_text(study) +
                              "\n[soft_tissue.dura]\nstructure = \"dura\"\nstiffness = 500.0\n");
  bone::save_bone(folder_ / "dura.nrrd", test::slabs_over_dura());
  const record::SessionReader reader(taught(study, "out") + "/S01.h5");
  const auto samples = reader.samples(0, reader.sample_count());
  const auto tool = reader.rows<record::ToolRow>();
  const protocols::DrillingInput input(protocols::load_bone_definition(study).drilling);
  const auto led = reader.rows<record::LedRow>();
  std::optional<bone::BoneTouch> hand;
  std::size_t next = reader.passes().at(0).first_sample - samples.front().sequence;
  std::size_t touched = 0;
  const auto verdict =
      protocols::BoneReplay(reader.path())
          .run(1, [&](std::uint64_t, std::uint64_t sequence, const bone::DrillingView&,
                      const std::shared_ptr<const protocols::BoneStage>& stage) {
            if (!hand) {
              hand.emplace(*stage->simulator);
            }
            // The bone stays as it is until what was followed next.
            const auto later =
                std::ranges::upper_bound(led, sequence, {}, &record::LedRow::sequence);
            const std::uint64_t end = later != led.end() ? later->sequence : sequence + 1;
            for (; next < samples.size() && samples[next].sequence < end; ++next) {
              device::DeviceReading reading;
              reading.tool = {samples[next].position, samples[next].velocity};
              reading.orientation = tool[next].orientation;
              const auto felt = hand->tick(*stage->simulator, input.of(reading, 1e-3).tool);
              for (Eigen::Index axis = 0; axis < 3; ++axis) {
                ASSERT_EQ(record::on_grid(felt.force[axis], record::kForceResolution),
                          tool[next].contact[axis])
                    << "tick " << samples[next].sequence;
              }
              touched += felt.force.isZero(0.0) ? 0 : 1;
            }
          });
  EXPECT_EQ(verdict.difference, "");
  EXPECT_GT(touched, 500u);
}

/// Two processes over the network of a relay.
class LiveTaughtBoneTest : public TaughtBoneTest {
 protected:
  void start(const fs::path& teaches, const fs::path& learns, const std::string& more = "") {
    const std::string secret = (folder_ / "tutoring.secret").string();
    if (!fs::exists(secret)) {
      run_command("haptrial secret " + secret);
    }
    const auto line = [&](const fs::path& file, const char* side) {
      return "run '" + file.string() + "' --subject P01 --secret " + secret + " --out " +
             (folder_ / side).string() + " " + more + " ";
    };
    const std::uint16_t port = test::free_port();
    teaches_ = std::make_unique<test::LiveCommand>(line(teaches, "teaching") + "--teach " +
                                                   std::to_string(port));
    ASSERT_NE(teaches_->line_after("waiting at port"), "");
    relay_ = std::make_unique<test::NetworkRelay>(
        port,
        test::RelayConditions{
            .delay = 0.01, .jitter = 0.005, .loss = 0.05, .duplication = 0.02, .reordering = 0.05});
    learns_ = std::make_unique<test::LiveCommand>(
        line(learns, "learning") + "--learn-from 127.0.0.1:" + std::to_string(relay_->port()));
  }
  record::SessionReader file(const std::string& side) const {
    return record::SessionReader(folder_ / side / "P01.h5");
  }

  std::unique_ptr<test::LiveCommand> teaches_;
  std::unique_ptr<test::NetworkRelay> relay_;
  std::unique_ptr<test::LiveCommand> learns_;
};

TEST_F(LiveTaughtBoneTest, TwoProcessesHaveOneBone) {
  const fs::path study = definition("patience = 20\n", 6.0);
  start(study, study);
  const test::CommandResult a = learns_->wait();
  const test::CommandResult b = teaches_->wait();
  ASSERT_EQ(a.status, 0) << a.errors << b.errors;
  ASSERT_EQ(b.status, 0) << b.errors;
  expect_one_bone(file("learning"), file("teaching"));
}

TEST_F(LiveTaughtBoneTest, AnotherBoneInTheFileIsSaidOnBothSides) {
  const fs::path study = definition("patience = 20\n", 2.0);
  fs::create_directory(folder_ / "other");
  fs::copy(study, folder_ / "other" / study.filename());
  bone::BoneModel bone = test::two_slabs();
  bone.labels[0] = 0;
  bone::save_bone(folder_ / "other" / "slabs.nrrd", bone);
  start(study, folder_ / "other" / study.filename());
  const test::CommandResult a = learns_->wait();
  const test::CommandResult b = teaches_->wait();
  ASSERT_EQ(a.status, 0) << a.errors << b.errors;
  ASSERT_EQ(b.status, 0) << b.errors;
  EXPECT_THAT(a.errors, HasSubstr("differ from the beginning"));
  EXPECT_THAT(b.errors, HasSubstr("bones of the two sides differ after"));
  EXPECT_THAT(texts_of(file("teaching"), "bone_differs"), testing::SizeIs(1));
  EXPECT_THAT(texts_of(file("learning"), "bone_differs"), testing::SizeIs(2));
}

/// Which side is killed while both drill their second bone.
class KilledBoneTest : public LiveTaughtBoneTest, public testing::WithParamInterface<const char*> {
 protected:
  /// Whether the side that learns has followed ticks of the second trial.
  bool is_in_second_trial() {
    const fs::path partial = folder_ / "learning" / "P01.h5.partial";
    return learns_->reaches([&] {
      try {
        const record::SessionReader reader(partial);
        const auto led = reader.rows<record::LedRow>();
        return reader.passes().size() == 1 && !led.empty() &&
               led.back().sequence > reader.passes()[0].last_sample;
      } catch (const std::exception&) {
        return false;
      }
    });
  }
  void kill_and_go_on(const fs::path& study) {
    start(study, study);
    ASSERT_TRUE(is_in_second_trial()) << learns_->errors() << teaches_->errors();
    const bool learner = std::string(GetParam()) == "learning";
    (learner ? learns_ : teaches_)->signal(SIGKILL);
    EXPECT_THAT((learner ? teaches_ : learns_)->wait().errors,
                HasSubstr("continue with --resume on both sides"));
    (learner ? learns_ : teaches_)->wait();
    start(study, study, "--resume");
    const test::CommandResult a = learns_->wait();
    const test::CommandResult b = teaches_->wait();
    ASSERT_EQ(a.status, 0) << a.errors << b.errors;
    ASSERT_EQ(b.status, 0) << a.errors << b.errors;
  }
};

TEST_P(KilledBoneTest, TheTrialIsDoneAgainFromItsBeginningAndEarlierBonesStay) {
  const fs::path study = definition("patience = 5\n", 8.0, {{"procedures", "procedures = 2"}});
  kill_and_go_on(study);
  std::vector<std::vector<record::ProcedureRow>> bones;
  for (const char* side : {"learning", "teaching"}) {
    const record::SessionReader reader = file(side);
    const record::Integrity integrity = record::check_session(reader);
    EXPECT_TRUE(integrity.ok) << side << testing::PrintToString(integrity.problems);
    EXPECT_THAT(texts_of(reader, "bone_checked"), testing::SizeIs(2)) << side;
    EXPECT_THAT(texts_of(reader, "bone_differs"), testing::IsEmpty()) << side;
    const auto anew = texts_of(reader, "bone_anew");
    if (std::string(side) != GetParam()) {  // the killed side's file may not know that it had begun
      EXPECT_THAT(anew, ElementsAre(HasSubstr("trial 2 is done again from its beginning")));
    }
    const record::PassRow last = reader.passes().back();
    EXPECT_EQ(last.trial, 2);
    EXPECT_EQ(last.status, record::PassStatus::kCompleted);
    EXPECT_GE(last.last_sample - last.first_sample + 1, 8000u) << side << ": all of its time";
    const auto procedures = reader.rows<record::ProcedureRow>();
    ASSERT_GE(procedures.size(), 2u);
    bones.push_back({procedures.front(), procedures.back()});
    for (const int trial : {1, 2}) {
      const protocols::ReplayVerdict again = protocols::BoneReplay(reader.path()).run(trial);
      EXPECT_EQ(again.difference, "") << side << ", trial " << trial;
      EXPECT_EQ(again.checksum, bones.back()[static_cast<std::size_t>(trial - 1)].checksum);
    }
  }
  for (std::size_t trial = 0; trial < 2; ++trial) {
    EXPECT_EQ(bones[0][trial].checksum, bones[1][trial].checksum);
    EXPECT_EQ(bones[0][trial].left, bones[1][trial].left);
    EXPECT_LT(bones[0][trial].left, bones[0][trial].before) << "it was drilled";
  }
}

INSTANTIATE_TEST_SUITE_P(LiveEitherSide, KilledBoneTest, testing::Values("learning", "teaching"),
                         [](const auto& side) { return std::string(side.param); });

}  // namespace
}  // namespace haptrial::taught_bone_test
