// Whole drilling sessions by the virtual hand: recorded, conserved, repeated to the bit.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <set>
#include <tuple>

#include "core/base/error.h"
#include "core/bone/record/drilling_tables.h"
#include "core/bone/record/recorded_bone.h"
#include "core/record/hdf5/session_writer.h"
#include "core/record/read/integrity.h"
#include "core/record/read/session_reader.h"
#include "experiments/runner/session.h"
#include "protocols/bone_drilling/bone_protocol.h"
#include "protocols/bone_drilling/bone_replay.h"
#include "protocols/bone_drilling/load_bones.h"
#include "tests/experiments/command.h"
#include "tests/experiments/session_runs.h"
#include "tests/experiments/small_drilling.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments::bone_session_test {
namespace {

using testing::HasSubstr;

constexpr double kSeconds = 14.0;

/// One session on the two slabs, shared by the tests that only read it.
class BoneSessionTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<test::TemporaryFolder>();
    definition_ = std::make_unique<protocols::BoneDefinition>(
        protocols::load_bone_definition(test::write_small_drilling(folder_->path(), kSeconds)));
    run("S01.h5");
  }
  static void TearDownTestSuite() {
    definition_.reset();
    folder_.reset();
  }
  static SessionSummary run(const char* file) {
    SessionRequest request =
        test::session_request(protocols::bone_drilling(), *definition_, *folder_ / file, 3);
    return run_session(request);
  }
  static record::SessionReader session() { return record::SessionReader(*folder_ / "S01.h5"); }

  static std::unique_ptr<test::TemporaryFolder> folder_;
  static std::unique_ptr<protocols::BoneDefinition> definition_;
};
std::unique_ptr<test::TemporaryFolder> BoneSessionTest::folder_;
std::unique_ptr<protocols::BoneDefinition> BoneSessionTest::definition_;

TEST_F(BoneSessionTest, EveryTickIsRecordedWithItsTool) {
  const record::SessionReader reader = session();
  const record::Integrity integrity = record::check_session(reader);
  EXPECT_TRUE(integrity.ok) << integrity.problems.front();
  const auto samples = reader.samples(0, reader.sample_count());
  const auto tool = reader.rows<record::ToolRow>();
  ASSERT_EQ(tool.size(), samples.size());
  std::size_t active = 0;
  std::set<int> tools;
  std::set<int> modes;
  for (std::size_t i = 0; i < tool.size(); ++i) {
    ASSERT_EQ(tool[i].sequence, samples[i].sequence);
    ASSERT_EQ(tool[i].active, samples[i].pass == 0);
    active += tool[i].active ? 1 : 0;
    tools.insert(tool[i].tool);
    modes.insert(tool[i].mode);
  }
  EXPECT_EQ(active, static_cast<std::size_t>(kSeconds * 1000.0));
  EXPECT_THAT(tools, testing::Contains(2)) << "the hand takes the suction at times";
  const auto passes = reader.passes();
  ASSERT_EQ(passes.size(), 1u);
  EXPECT_EQ(passes[0].phase, record::kDrillingPhase);
  EXPECT_EQ(passes[0].status, record::PassStatus::kCompleted);
}

/// Voxels that a file says were emptied, against the ones that are missing in the end.
TEST_F(BoneSessionTest, RemovalsAndCrumbsAreTheDifferenceOfStartAndEnd) {
  const record::SessionReader reader = session();
  const bone::BoneModel model = bone::model_of(record::recorded_bones(reader).front());
  std::set<std::tuple<int, int, int>> gone;
  for (const record::RemovalRow& row : reader.rows<record::RemovalRow>()) {
    const auto& v = row.voxel;
    EXPECT_TRUE(gone.insert({v[0], v[1], v[2]}).second) << "emptied twice";
    EXPECT_EQ(row.label, model.labels[model.grid.index(v[0], v[1], v[2])]);
  }
  ASSERT_GT(gone.size(), 30u);
  std::shared_ptr<const protocols::BoneStage> stage;
  const protocols::BoneReplay replay(*folder_ / "S01.h5");
  replay.run(1, [&](std::uint64_t, std::uint64_t, const bone::DrillingView&,
                    const std::shared_ptr<const protocols::BoneStage>& now) { stage = now; });
  std::size_t crumbs = 0;
  std::size_t missing = 0;
  const bone::BoneWorld& world = std::as_const(*stage->simulator).world();
  geometry::visit_voxels(model.grid, [&](const bone::Voxel& voxel, std::size_t at) {
    if (model.labels[at] == 0) {
      return;
    }
    const bool there = world.holder(voxel) >= 0;
    missing += there ? 0 : 1;
    if (there) {
      EXPECT_FALSE(gone.contains({voxel.x(), voxel.y(), voxel.z()}));
    } else if (!gone.contains({voxel.x(), voxel.y(), voxel.z()})) {
      ++crumbs;  // turned to dust with a part that was too small
    }
  });
  EXPECT_EQ(missing, gone.size() + crumbs);
  std::size_t dusted = 0;
  for (const record::SplitRow& row : reader.rows<record::SplitRow>()) {
    dusted += row.to < 0 ? 1 : 0;
  }
  EXPECT_EQ(crumbs > 0, dusted > 0);
}

TEST_F(BoneSessionTest, BoneAndDustAddUpToTheStart) {
  const auto procedures = session().rows<record::ProcedureRow>();
  ASSERT_EQ(procedures.size(), 1u);
  const record::ProcedureRow& p = procedures.front();
  double filled = 0.0;
  for (const std::uint8_t label : test::two_slabs().labels) {
    filled += label != 0 ? 1.0 : 0.0;
  }
  EXPECT_EQ(p.before, filled);
  EXPECT_LT(p.left, p.before - 20.0);
  EXPECT_GT(p.suctioned, 0.0);
  EXPECT_NEAR(p.left + p.cut + p.dust + p.suctioned + p.fallen, p.before,
              kSeconds * 1000.0 * 0x1p-20);
}

TEST_F(BoneSessionTest, ARepetitionGivesTheSameRows) {
  run("again.h5");
  const record::SessionReader a = session();
  const record::SessionReader b(*folder_ / "again.h5");
  ASSERT_EQ(a.sample_count(), b.sample_count());
  const auto bytes = [](const record::SessionReader& reader) {
    std::string all;
    for (const record::Sample& s : reader.samples(0, reader.sample_count())) {
      all.append(reinterpret_cast<const char*>(s.position.data()), 24);
      all.append(reinterpret_cast<const char*>(s.force.data()), 24);
    }
    for (const record::ToolRow& row : reader.rows<record::ToolRow>()) {
      all.append(reinterpret_cast<const char*>(&row.removed), 8);
      all.append(reinterpret_cast<const char*>(row.contact.data()), 24);
    }
    for (const record::RemovalRow& row : reader.rows<record::RemovalRow>()) {
      all.append(reinterpret_cast<const char*>(row.voxel.data()), 12);
      all.append(reinterpret_cast<const char*>(&row.force), 8);
    }
    for (const record::ProcedureRow& row : reader.rows<record::ProcedureRow>()) {
      all.append(reinterpret_cast<const char*>(&row.checksum), 8);
      all.append(reinterpret_cast<const char*>(&row.suctioned), 8);
    }
    return all;
  };
  EXPECT_TRUE(bytes(a) == bytes(b));
}

TEST_F(BoneSessionTest, AReplayGivesTheSameBone) {
  const protocols::ReplayVerdict verdict = protocols::BoneReplay(*folder_ / "S01.h5").run(1);
  EXPECT_EQ(verdict.difference, "");
  EXPECT_TRUE(verdict.whole);
  EXPECT_EQ(verdict.ticks, static_cast<std::uint64_t>(kSeconds * 1000.0));
  EXPECT_EQ(verdict.checksum, session().rows<record::ProcedureRow>().front().checksum);
  const test::CommandResult command =
      test::run_command("haptrial replay '" + (*folder_ / "S01.h5").string() + "'");
  EXPECT_EQ(command.status, 0) << command.errors;
  EXPECT_THAT(command.output, HasSubstr("trial 1: the same bone, 14000 ticks in 1 pass,"));
}

/// The file with the hand a tenth of a millimetre aside on one tick in the middle of the drilling.
TEST_F(BoneSessionTest, AReplaySaysWhereItFirstDiffers) {
  const record::SessionReader reader = session();
  auto samples = reader.samples(0, reader.sample_count());
  const auto removals = reader.rows<record::RemovalRow>();
  const std::uint64_t when = removals[removals.size() / 2].sequence;
  for (std::uint64_t at = when; at < when + 20; ++at) {
    samples[at].position.y() += 0.002;
  }
  {
    record::SessionWriter writer(*folder_ / "moved.h5", reader.info(), record::drilling_tables(),
                                 record::rows_of(record::recorded_bones(reader)));
    writer.add(std::span<const record::ToolRow>(reader.rows<record::ToolRow>()));
    writer.add(std::span<const record::RemovalRow>(removals));
    writer.add(std::span<const record::SplitRow>(reader.rows<record::SplitRow>()));
    writer.add(std::span<const record::ProcedureRow>(reader.rows<record::ProcedureRow>()));
    writer.append(samples);
    writer.add_pass(reader.passes().front());
    writer.close();
  }
  const protocols::ReplayVerdict verdict = protocols::BoneReplay(*folder_ / "moved.h5").run(1);
  EXPECT_THAT(verdict.difference, HasSubstr("on tick "));
  const std::uint64_t told = std::stoull(verdict.difference.substr(8));
  EXPECT_GE(told, when);
  EXPECT_LE(told, when + 500);
  const test::CommandResult command =
      test::run_command("haptrial replay '" + (*folder_ / "moved.h5").string() + "'");
  EXPECT_EQ(command.status, 1);
  EXPECT_THAT(command.errors,
              HasSubstr("differs from the recording when simulated again: on tick"));
}

TEST_F(BoneSessionTest, ATrialThatIsNotThereIsNamed) {
  EXPECT_THROW(protocols::BoneReplay(*folder_ / "S01.h5").run(7), InputError);
  const test::CommandResult command =
      test::run_command("haptrial replay '" + (*folder_ / "S01.h5").string() + "' --trial 7");
  EXPECT_EQ(command.status, 2);
  EXPECT_THAT(command.errors, HasSubstr("--trial is 7; allowed: 1 to 1"));
  const test::CommandResult phase = test::run_command(
      "haptrial replay '" + (*folder_ / "S01.h5").string() + "' --phase training");
  EXPECT_EQ(phase.status, 2);
  EXPECT_THAT(phase.errors, HasSubstr("--phase is 'training'; allowed: drilling"));
}

}  // namespace
}  // namespace haptrial::experiments::bone_session_test
