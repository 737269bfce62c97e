// Drillings with burrs that are no balls, shafts that are felt, wear and reverse: recorded, drawn,
// repeated to the bit.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "core/bone/record/drilling_tables.h"
#include "core/bone/record/recorded_bone.h"
#include "core/bone/record/tool_rows.h"
#include "core/record/hdf5/session_writer.h"
#include "core/record/read/integrity.h"
#include "core/record/read/session_reader.h"
#include "protocols/bone_drilling/bone_replay.h"
#include "tests/experiments/command.h"
#include "tests/experiments/shipped.h"
#include "tests/experiments/small_drilling.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments::burr_session_test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr double kSeconds = 8.0;

/// The small drilling with other burrs. @param cutting  lines of its first burr
fs::path write_study(const fs::path& folder, const std::string& cutting) {
  const fs::path file =
      test::write_small_drilling(folder, kSeconds, {{"look_button", "look_button = 6"}});
  std::string text = test::read_text(file);
  const std::string before = "kind = \"cutting\"\n";
  const std::size_t from = text.find(before) + before.size();
  const std::size_t end = text.find("\n[", from);
  text.replace(from, end - from, cutting + "\n");
  test::write_text(file, text);
  return file;
}

test::CommandResult dry_run(const fs::path& study, const fs::path& out) {
  return test::run_command("haptrial dry-run '" + study.string() + "' --out '" + out.string() +
                           "'");
}

void expect_the_same_bone(const fs::path& session) {
  const test::CommandResult same = test::run_command("haptrial replay '" + session.string() + "'");
  EXPECT_EQ(same.status, 0) << same.errors;
  EXPECT_THAT(same.output, HasSubstr("the same bone, 8000 ticks"));
}

std::uint64_t emptied(const record::SessionReader& reader) {
  return reader.rows<record::ProcedureRow>().front().emptied;
}

TEST(BurrSessionTest, EveryShapeDrillsAndIsInTheFileAndReplaysToTheSameBone) {
  for (const auto& [lines, shape, length] :
       {std::tuple{"shape = \"cylinder\"\ndiameter = 0.003\nlength = 0.006", 1, 0.006},
        std::tuple{"shape = \"cone\"\ndiameter = 0.004\nlength = 0.006", 2, 0.006},
        std::tuple{"shape = \"pear\"\ndiameter = 0.004\nlength = 0.007", 3, 0.007}}) {
    const test::TemporaryFolder folder;
    const fs::path study = write_study(folder.path(), lines);
    const test::CommandResult done = dry_run(study, folder / "out");
    ASSERT_EQ(done.status, 0) << done.errors;
    const fs::path session = folder / "out" / "S01.h5";
    const record::SessionReader reader(session);
    const record::Integrity integrity = record::check_session(reader);
    EXPECT_TRUE(integrity.ok) << integrity.problems.front();
    EXPECT_GT(emptied(reader), 20u) << lines;
    const auto burrs = reader.rows<record::BurrRow>();
    ASSERT_EQ(burrs.size(), 2u) << "the suction is none";
    EXPECT_EQ(burrs[0].name, "cutting");
    EXPECT_EQ(burrs[0].shape, shape);
    EXPECT_EQ(burrs[0].length, length);
    EXPECT_EQ(burrs[0].kind, 1);
    EXPECT_EQ(burrs[1].shape, 0);
    EXPECT_EQ(burrs[1].length, burrs[1].diameter);
    EXPECT_FALSE(reader.has(record::table_of<record::HandpieceRow>())) << "nothing to tell";
    expect_the_same_bone(session);
  }
}

constexpr const char* kWorn =
    "diameter = 0.004\nwear_volume = 2e-8\nshaft_radius = 0.0015\nshaft_length = 0.03";

/// One dry run of a burr that wears with a shaft that is felt and a button for reverse, which the
/// virtual hand presses when it looks around.
class WornBurrSessionTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<test::TemporaryFolder>();
    const fs::path study = write_study(folder_->path(), kWorn);
    std::string text = test::read_text(study);
    const auto replace = [&text](const std::string& line, const std::string& by) {
      text.replace(text.find(line), line.size(), by);
    };
    replace("camera_turn = [4]\n", "reverse = [6]\n");
    replace("handle = [0.0, 0.8, 0.6]", "handle = [0.0, 0.3, 0.95]");  // low over the bone
    test::write_text(study, text);
    const test::CommandResult done = dry_run(study, *folder_ / "out");
    ASSERT_EQ(done.status, 0) << done.errors;
  }
  static void TearDownTestSuite() { folder_.reset(); }
  static fs::path file() { return *folder_ / "out" / "S01.h5"; }

  static std::unique_ptr<test::TemporaryFolder> folder_;
};
std::unique_ptr<test::TemporaryFolder> WornBurrSessionTest::folder_;

TEST_F(WornBurrSessionTest, SharpnessIsWhatTheRemovedVolumeSays) {
  const record::SessionReader reader(file());
  const auto held = reader.rows<record::HandpieceRow>();
  const auto tool = reader.rows<record::ToolRow>();
  ASSERT_EQ(held.size(), reader.sample_count());
  const double voxel = 1e-3 * 1e-3 * 1e-3;
  double volume = 0.0;
  for (std::size_t n = 0; n < held.size(); ++n) {
    ASSERT_EQ(held[n].sequence, tool[n].sequence);
    if (tool[n].active && tool[n].tool == 0) {
      volume += voxel * tool[n].removed;
      EXPECT_NEAR(held[n].sharpness, 2e-8 / (2e-8 + volume), 1e-4);
    }
  }
  EXPECT_GT(volume, 2e-8) << "it has worn";
}

TEST_F(WornBurrSessionTest, TheShaftIsFeltAndReverseIsRecorded) {
  const record::SessionReader reader(file());
  const auto held = reader.rows<record::HandpieceRow>();
  const auto felt = std::ranges::count_if(
      held, [](const record::HandpieceRow& row) { return row.shaft.norm() > 0.05; });
  EXPECT_GT(felt, 50);
  EXPECT_TRUE(std::ranges::any_of(held, &record::HandpieceRow::reversed));
  const auto burrs = reader.rows<record::BurrRow>();
  EXPECT_EQ(burrs[0].wear_volume, 2e-8);
  EXPECT_EQ(burrs[0].shaft_radius, 0.0015);
  EXPECT_EQ(burrs[0].shaft_length, 0.03);
}

TEST_F(WornBurrSessionTest, AReplayIsTheSame) { expect_the_same_bone(file()); }

/// A copy in which the handpiece tells something else from a tick on.
template <class Change>
std::string verdict_of(const record::SessionReader& reader, const fs::path& copy, Change&& change) {
  auto held = reader.rows<record::HandpieceRow>();
  change(held);
  record::TableList tables = record::drilling_tables();
  tables.push_back(&record::table_of<record::HandpieceRow>());
  record::SessionWriter writer(copy, reader.info(), tables,
                               record::rows_of(record::recorded_bones(reader)));
  writer.add(std::span<const record::ToolRow>(reader.rows<record::ToolRow>()));
  writer.add(std::span<const record::HandpieceRow>(held));
  writer.add(std::span<const record::RemovalRow>(reader.rows<record::RemovalRow>()));
  writer.add(std::span<const record::SplitRow>(reader.rows<record::SplitRow>()));
  writer.add(std::span<const record::ProcedureRow>(reader.rows<record::ProcedureRow>()));
  writer.append(reader.samples(0, reader.sample_count()));
  writer.add_pass(reader.passes().front());
  writer.close();
  return protocols::BoneReplay(copy).run(1).difference;
}

TEST_F(WornBurrSessionTest, AReplaySaysWhereTheHandpieceFirstDiffers) {
  const record::SessionReader reader(file());
  using Rows = std::vector<record::HandpieceRow>;
  EXPECT_EQ(verdict_of(reader, *folder_ / "same.h5", [](Rows&) {}), "");
  EXPECT_THAT(verdict_of(reader, *folder_ / "shaft.h5",
                         [](Rows& rows) { rows[4000].shaft.x() += 0x1p-10; }),
              HasSubstr("on tick 4000 the record has"));
  EXPECT_THAT(verdict_of(reader, *folder_ / "sharp.h5",
                         [](Rows& rows) { rows[5000].sharpness *= 1.0 - 1e-15; }),
              HasSubstr("on tick 5000 the record has a burr of sharpness"));
}

TEST(BurrDefinitionTest, WhatCannotBeIsSaid) {
  const auto says = [](const std::string& cutting) {
    const test::TemporaryFolder folder;
    const fs::path study = write_study(folder.path(), cutting);
    const test::CommandResult result =
        test::run_command("haptrial validate '" + study.string() + "'");
    EXPECT_EQ(result.status, 2) << cutting;
    return result.errors;
  };
  EXPECT_THAT(says("shape = \"cube\"\ndiameter = 0.004"), HasSubstr("tools.cutting.shape"));
  EXPECT_THAT(says("shape = \"cylinder\"\ndiameter = 0.004"), HasSubstr("tools.cutting.length"));
  EXPECT_THAT(
      says("diameter = 0.004\nshaft_radius = 0.003\nshaft_length = 0.02"),
      HasSubstr("tools.cutting.shaft_radius is 0.003; allowed: at most half of diameter, 0.004 "
                "[m]"));
  EXPECT_THAT(says("diameter = 0.004\nshaft_radius = 0.001"),
              HasSubstr("tools.cutting.shaft_length"));
}

}  // namespace
}  // namespace haptrial::experiments::burr_session_test
