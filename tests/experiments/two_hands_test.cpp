// Drillings with two devices, a burr at one and a tube at the other: recorded, felt, killed,
// repeated to the bit.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/bone/record/bone_rows.h"
#include "core/bone/record/drilling_tables.h"
#include "core/bone/record/recorded_bone.h"
#include "core/bone/record/tool_rows.h"
#include "core/record/hdf5/session_writer.h"
#include "core/record/read/integrity.h"
#include "core/record/read/session_reader.h"
#include "core/record/rows/device_rows.h"
#include "protocols/bone_drilling/bone_replay.h"
#include "tests/experiments/command.h"
#include "tests/experiments/live_command.h"
#include "tests/experiments/shipped.h"
#include "tests/experiments/small_drilling.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments::two_hands_test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

const std::string kSecond =
    "[second_hand]\nhandle = [0.0, 1.0, 0.0]\nbeside = [0.003, -0.002, 0.0]\n";
const std::string kHeat = "[heat]\nshare = 1.0\n";

/// The small drilling, without suction in the first hand, and with more tables.
fs::path write_study(const fs::path& folder, double seconds, const std::string& more) {
  const fs::path file =
      test::write_small_drilling(folder, seconds,
                                 {{"in_hand", "in_hand = [\"cutting\", \"diamond\"]"},
                                  {"next_button", ""},
                                  {"previous_button", ""},
                                  {"suction_tool", ""},
                                  {"strokes_to_suction", ""},
                                  {"suction_time", ""}});
  std::string text = test::read_text(file);
  const std::string tool = "[tools.suction]\ntype = \"suction\"\nradius = 0.0012";
  text.erase(text.find(tool), tool.size());
  test::write_text(file, text + "\n" + more);
  return file;
}

/// One dry run, shared by the tests that only read it.
class TwoHandsTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<test::TemporaryFolder>();
    const fs::path study = write_study(folder_->path(), 10.0, kSecond + kHeat);
    const test::CommandResult done = test::run_command(
        "haptrial dry-run '" + study.string() + "' --out '" + (*folder_ / "out").string() + "'");
    ASSERT_EQ(done.status, 0) << done.errors;
  }
  static void TearDownTestSuite() { folder_.reset(); }
  static fs::path file() { return *folder_ / "out" / "S01.h5"; }

  static std::unique_ptr<test::TemporaryFolder> folder_;
};
std::unique_ptr<test::TemporaryFolder> TwoHandsTest::folder_;

TEST_F(TwoHandsTest, BothHandsAreInTheFileTickByTick) {
  const record::SessionReader reader(file());
  const record::Integrity integrity = record::check_session(reader);
  EXPECT_TRUE(integrity.ok) << integrity.problems.front();
  const auto samples = reader.samples(0, reader.sample_count());
  const auto hand = reader.rows<record::SecondHandRow>();
  const auto device = reader.rows<record::DeviceRow>();
  ASSERT_EQ(hand.size(), samples.size());
  ASSERT_EQ(device.size(), samples.size());
  std::size_t felt = 0;
  for (std::size_t i = 0; i < hand.size(); ++i) {
    ASSERT_EQ(hand[i].sequence, samples[i].sequence);
    ASSERT_EQ(device[i].sequence, samples[i].sequence);
    const bool past_the_ramp = samples[i].pass == 0 && i > 500 && i < 9500;
    if (past_the_ramp && hand[i].contact.norm() > 0.0) {
      ++felt;
      const Eigen::Vector3d limited = hand[i].contact * std::min(1.0, 4.0 / hand[i].contact.norm());
      EXPECT_LT((device[i].force - limited).norm(), 0.5) << "but for the envelope's rate";
    }
  }
  EXPECT_GT(felt, 200u) << "the tube meets bone";
  EXPECT_TRUE(reader.rows<record::ToolContactRow>().empty()) << "the tools do not push";
}

TEST_F(TwoHandsTest, TheOtherHandSucksTheDustAndRinses) {
  const record::SessionReader reader(file());
  const auto procedures = reader.rows<record::ProcedureRow>();
  ASSERT_EQ(procedures.size(), 1u);
  const record::ProcedureRow& p = procedures.front();
  EXPECT_GT(p.suctioned, 0.2 * (p.before - p.left));
  EXPECT_NEAR(p.left + p.cut + p.dust + p.suctioned + p.fallen, p.before, 0.05);
  const auto field = reader.rows<record::FieldRow>();
  ASSERT_EQ(field.size(), 1u);
  EXPECT_GT(field[0].hottest, 37.5);
  EXPECT_EQ(field[0].bled, 0.0);
  const auto hand = reader.rows<record::SecondHandRow>();
  EXPECT_GT(std::ranges::count_if(hand, &record::SecondHandRow::rinses), 1000);
}

TEST_F(TwoHandsTest, TheReportTellsHeatAndBlood) {
  const test::TemporaryFolder study;
  fs::copy(file(), study / "S01.h5");
  const test::CommandResult done =
      test::run_command("haptrial analyze '" + study.path().string() + "'");
  ASSERT_EQ(done.status, 0) << done.errors;
  const auto field = record::SessionReader(file()).rows<record::FieldRow>();
  ASSERT_EQ(field.size(), 1u);
  EXPECT_THAT(test::read_text(study / "heat_and_blood.csv"),
              HasSubstr(fmt::format(",1,1,{:.3f},{:.3f},0,0,0\n", field[0].hottest,
                                    field[0].harmful_time)));
  const std::string report = test::read_text(study / "report.md");
  EXPECT_THAT(report, HasSubstr("Heat and blood (simulated)"));
  EXPECT_THAT(report, HasSubstr(fmt::format("| 1 | {:#.4g} |", field[0].hottest)));
  const auto json = nlohmann::json::parse(test::read_text(study / "statistics.json"));
  const auto& row = json["heat_and_blood"]["tables"]["procedures"][0];
  EXPECT_EQ(row["session"], "S01.h5");
  EXPECT_DOUBLE_EQ(row["hottest_degC"], field[0].hottest);
}

TEST_F(TwoHandsTest, AReplayFeelsTheSameInBothHands) {
  const test::CommandResult same = test::run_command("haptrial replay '" + file().string() + "'");
  EXPECT_EQ(same.status, 0) << same.errors;
  EXPECT_THAT(same.output, HasSubstr("the same bone, 10000 ticks"));
}

/// A copy of the file in which the second device was elsewhere for some ticks.
fs::path with_a_moved_tube(const record::SessionReader& reader, const fs::path& copy,
                           std::uint64_t when) {
  auto devices = reader.rows<record::DeviceRow>();
  for (record::DeviceRow& row : devices) {
    row.position.y() -= row.sequence >= when && row.sequence < when + 20 ? 0.002 : 0.0;
  }
  record::TableList tables = record::drilling_tables();
  tables.push_back(&record::table_of<record::DeviceRow>());
  tables.push_back(&record::table_of<record::SecondHandRow>());
  record::SessionWriter writer(copy, reader.info(), tables,
                               record::rows_of(record::recorded_bones(reader)));
  writer.add(std::span<const record::ToolRow>(reader.rows<record::ToolRow>()));
  writer.add(std::span<const record::DeviceRow>(devices));
  writer.add(std::span<const record::SecondHandRow>(reader.rows<record::SecondHandRow>()));
  writer.add(std::span<const record::RemovalRow>(reader.rows<record::RemovalRow>()));
  writer.add(std::span<const record::SplitRow>(reader.rows<record::SplitRow>()));
  writer.add(std::span<const record::ProcedureRow>(reader.rows<record::ProcedureRow>()));
  writer.append(reader.samples(0, reader.sample_count()));
  writer.add_pass(reader.passes().front());
  writer.close();
  return copy;
}

TEST_F(TwoHandsTest, AReplaySaysWhereTheTubeFirstDiffers) {
  const record::SessionReader reader(file());
  const auto hand = reader.rows<record::SecondHandRow>();
  const auto touches = std::ranges::find_if(
      hand, [](const record::SecondHandRow& row) { return row.contact.norm() > 0.1; });
  ASSERT_NE(touches, hand.end());
  const fs::path moved = with_a_moved_tube(reader, *folder_ / "moved.h5", touches->sequence);
  const protocols::ReplayVerdict verdict = protocols::BoneReplay(moved).run(1);
  EXPECT_THAT(verdict.difference,
              HasSubstr("on tick " + std::to_string(touches->sequence) + " the record has"));
  EXPECT_THAT(verdict.difference, HasSubstr("on the tube of the second hand"));
}

TEST(TwoHandsMeetTest, BurrAndTubePushEachOtherByTheSameAndAReplayFeelsIt) {
  const test::TemporaryFolder folder;
  const fs::path study =
      write_study(folder.path(), 6.0,
                  "[second_hand]\nhandle = [0.0, 1.0, 0.0]\nbeside = [0.0048, 0.0, 0.0]\n"
                  "tool_stiffness = 1500.0\n");
  const fs::path out = folder / "out";
  const test::CommandResult done =
      test::run_command("haptrial dry-run '" + study.string() + "' --out '" + out.string() + "'");
  ASSERT_EQ(done.status, 0) << done.errors;
  const record::SessionReader reader(out / "S01.h5");
  const record::Integrity integrity = record::check_session(reader);
  EXPECT_TRUE(integrity.ok) << integrity.problems.front();
  const auto samples = reader.samples(0, reader.sample_count());
  const auto tool = reader.rows<record::ToolRow>();
  const auto hand = reader.rows<record::SecondHandRow>();
  const auto device = reader.rows<record::DeviceRow>();
  const auto met = reader.rows<record::ToolContactRow>();
  ASSERT_EQ(met.size(), samples.size());
  std::size_t alone = 0;
  for (std::size_t i = 500; i < std::min<std::size_t>(samples.size(), 5500); ++i) {
    ASSERT_EQ(met[i].sequence, samples[i].sequence);
    const bool steady = (met[i].force - met[i - 1].force).norm() < 0.05;  // the envelope's rate
    if (met[i].force.norm() > 0.1 && steady && tool[i].immersed == 0 && hand[i].immersed == 0) {
      ++alone;
      EXPECT_LT((samples[i].force - met[i].force).norm(), 0.06) << i;
      EXPECT_LT((device[i].force + met[i].force).norm(), 0.06) << i;
    }
  }
  EXPECT_GT(alone, 50u) << "they meet where no bone is";
  const test::CommandResult same =
      test::run_command("haptrial replay '" + (out / "S01.h5").string() + "'");
  EXPECT_EQ(same.status, 0) << same.errors;
  EXPECT_THAT(same.output, HasSubstr("the same bone, 6000 ticks"));
}

TEST(LiveTwoHandsTest, AfterAKillBothHandsGoOnAtTheBoneAsItStood) {
  const test::TemporaryFolder folder;
  const fs::path study = write_study(folder.path(), 20.0, kSecond + kHeat);
  const std::string run =
      "run '" + study.string() + "' --subject S01 --out '" + (folder / "out").string() + "' ";
  const fs::path partial = folder / "out" / "S01.h5.partial";
  {
    test::LiveCommand session(run);
    ASSERT_TRUE(session.reaches([&] {
      std::error_code ignored;
      return fs::exists(partial, ignored) &&
             record::SessionReader(partial).count<record::RemovalRow>() > 10;
    })) << session.errors();
    session.signal(SIGKILL);
    session.wait();
  }
  test::LiveCommand session(run + "--resume");
  const test::CommandResult ended = session.wait();
  ASSERT_EQ(ended.status, 0) << ended.errors;
  EXPECT_THAT(ended.errors, HasSubstr("trial 1 continues with the bone as it was after"));
  EXPECT_THAT(ended.output, HasSubstr(" 0 lost records"));
  const fs::path file = folder / "out" / "S01.h5";
  const record::SessionReader reader(file);
  const record::Integrity integrity = record::check_session(reader);
  EXPECT_TRUE(integrity.ok) << integrity.problems.front();
  EXPECT_EQ(reader.rows<record::SecondHandRow>().size(), reader.sample_count());
  const protocols::ReplayVerdict verdict = protocols::BoneReplay(file).run(1);
  EXPECT_EQ(verdict.difference, "");
  EXPECT_EQ(verdict.passes, 2);
  EXPECT_EQ(verdict.ticks, 20000u);
}

TEST(TwoHandsDefinitionTest, WhatCannotBeIsSaid) {
  const auto says = [](const std::string& more) {
    const test::TemporaryFolder folder;
    const fs::path study = write_study(folder.path(), 2.0, more);
    const test::CommandResult result =
        test::run_command("haptrial validate '" + study.string() + "'");
    EXPECT_EQ(result.status, 2) << more;
    return result.errors;
  };
  EXPECT_THAT(says("[second_hand]\n"), HasSubstr("second_hand.handle"));
  EXPECT_THAT(says(kSecond + "force_limit = 10.0\n"),
              HasSubstr("second_hand.force_limit is 10; allowed: at most envelope.max_force"));
  EXPECT_THAT(says(kSecond + "radius = 1.0\n"), HasSubstr("second_hand.radius"));
  EXPECT_THAT(says(kSecond + "tool_stiffness = 9000.0\n"),
              HasSubstr("second_hand.tool_stiffness is 9000; allowed: a number of at least 0 and "
                        "at most 5000 [N/m]"));
  EXPECT_THAT(says("[heat]\nloss = 1.0\nrinsed_loss = 0.5\n"),
              HasSubstr("heat.rinsed_loss is 0.5; allowed: at least loss, 1 [W/K]"));
}

/// The small drilling with one vessel that bleeds. @returns what validate says
test::CommandResult validated_with_vessel(const std::string& vessel) {
  const test::TemporaryFolder folder;
  const fs::path study = write_study(folder.path(), 2.0, "");
  std::string text = test::read_text(study);
  const std::string key = "structures = [";
  const std::size_t from = text.find(key, text.find("[bleeding]")) + key.size();
  text.replace(from, text.find(']', from) - from, "\"" + vessel + "\"");
  test::write_text(study, text);
  return test::run_command("haptrial validate '" + study.string() + "'");
}

/// A definition may be for several bones, of which some lack a vessel.
TEST(TwoHandsDefinitionTest, AVesselThatTheBoneLacksDoesNotBleedAndAnUnknownOneIsSaid) {
  const test::CommandResult lacking = validated_with_vessel("sigmoid sinus");
  EXPECT_EQ(lacking.status, 0) << lacking.errors;
  const test::CommandResult unknown = validated_with_vessel("sigmoid vein");
  EXPECT_EQ(unknown.status, 2);
  EXPECT_THAT(unknown.errors, HasSubstr("has no structure 'sigmoid vein'; it has "));
}

TEST(TwoHandsDefinitionTest, ABoneWithTwoHandsIsNotSharedOverALink) {
  const test::TemporaryFolder folder;
  const fs::path study = write_study(folder.path(), 2.0, kSecond);
  const test::CommandResult result =
      test::run_command("haptrial dry-run '" + study.string() + "' --taught --out '" +
                        (folder / "out").string() + "'");
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.errors, HasSubstr("leave [second_hand] out"));
}

}  // namespace
}  // namespace haptrial::experiments::two_hands_test
