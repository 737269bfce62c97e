// The tables of drillings: every field comes back, what a kill leaves goes on, what a damaged file
// holds is found.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <set>

#include "core/base/error.h"
#include "core/base/file_text.h"
#include "core/bone/record/drilling_tables.h"
#include "core/record/hdf5/session_writer.h"
#include "core/record/read/integrity.h"
#include "core/record/read/session_reader.h"
#include "core/record/recovery/recover.h"
#include "core/record/recovery/session_resume.h"
#include "core/record/rows/session_tables.h"
#include "core/record/table/schema.h"
#include "tests/core/record/session_fixture.h"

namespace haptrial::record::drilling_record_test {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;

double on(double value, double step) { return step * std::nearbyint(value / step); }

void expect_same(const ToolRow& given, const ToolRow& found) {
  EXPECT_EQ(found.sequence, given.sequence);
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(found.orientation.coeffs()[i], on(given.orientation.coeffs()[i], 0x1p-20));
  }
  EXPECT_EQ(found.buttons, given.buttons);
  EXPECT_EQ(found.keys, given.keys);
  EXPECT_EQ(found.pedal, on(given.pedal, 0x1p-10));
  EXPECT_EQ(found.tool, given.tool);
  EXPECT_EQ(found.mode, given.mode);
  EXPECT_EQ(found.active, given.active);
  EXPECT_EQ(found.power, given.power);
  EXPECT_EQ(found.piece, given.piece);
  EXPECT_EQ(found.immersed, given.immersed);
  EXPECT_EQ(found.removed, static_cast<double>(static_cast<float>(given.removed)));
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(found.contact[i], on(given.contact[i], 0x1p-13));
  }
}

RemovalRow removal(std::uint64_t sequence) {
  const auto n = static_cast<std::int32_t>(sequence);
  return {sequence, n % 3, {n, 2 * n, 3 * n}, static_cast<std::uint8_t>(1 + n % 9), n % 2 == 0,
          0.5 + n,  0.25};
}

template <class Row>
void add(SessionWriter& writer, const std::vector<Row>& rows) {
  writer.add(std::span(rows));
}

SessionInfo live_info() {
  SessionInfo info = test::example_info();
  info.clock = "real";
  return info;
}

/// Ticks [from, to) with a removal on every tenth.
void drill(SessionWriter& writer, std::uint64_t from, std::uint64_t to) {
  std::vector<Sample> samples = test::hand_motion(to, 4);
  std::vector<ToolRow> tool = test::tool_motion(to, 4);
  for (Sample& sample : samples) {
    sample.pass = 0;
  }
  samples.erase(samples.begin(), samples.begin() + static_cast<std::ptrdiff_t>(from));
  tool.erase(tool.begin(), tool.begin() + static_cast<std::ptrdiff_t>(from));
  add(writer, tool);
  std::vector<RemovalRow> removals;
  for (std::uint64_t at = from; at < to; at += 10) {
    removals.push_back(removal(at));
  }
  add(writer, removals);
  writer.append(samples);
}

TEST(DrillingRecordTest, EveryFieldComesBackOnItsGrid) {
  const TemporaryFolder folder;
  const std::vector<BoneRecord> bones{test::small_bone()};
  const std::vector<ToolRow> tool = test::tool_motion(5000, 1);
  {
    SessionWriter writer(folder / "a.h5", test::example_info(), drilling_tables(), rows_of(bones));
    add(writer, tool);
    add<RemovalRow>(writer, {removal(3), removal(1000)});
    add<CameraRow>(writer, {{7, -3, {1, 2, 3}, {4, 5, 6}, {0, 0.6, 0.8}, 0.1}});
    add<SplitRow>(writer, {{9, 1, 2, {3, -4, 5}}, {9, 1, -1, {6, 7, 8}}});
    add<ProcedureRow>(writer, {{0, 1, 2, 3, 4.5, 5.5, 6.5, 7.5, 8.5, 9.5, ~std::uint64_t{0}}});
    writer.close();
  }
  const SessionReader reader(folder / "a.h5");
  ASSERT_TRUE(drills(reader));
  const std::vector<ToolRow> found = reader.rows<ToolRow>();
  ASSERT_EQ(found.size(), tool.size());
  for (std::size_t i = 0; i < tool.size(); ++i) {
    expect_same(tool[i], found[i]);
  }
  const auto removals = reader.rows<RemovalRow>();
  ASSERT_EQ(removals.size(), 2u);
  EXPECT_EQ(removals[1].sequence, 1000u);
  EXPECT_EQ(removals[1].piece, 1);
  EXPECT_EQ(removals[1].voxel, (std::array<std::int32_t, 3>{1000, 2000, 3000}));
  EXPECT_EQ(removals[1].label, 2);
  EXPECT_EQ(removals[1].force, 1000.5);
  EXPECT_EQ(removals[1].speed, 0.25);
  const auto camera = reader.rows<CameraRow>();
  ASSERT_EQ(camera.size(), 1u);
  EXPECT_EQ(camera[0].time_ns, -3);
  EXPECT_EQ(camera[0].target, Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ(camera[0].up, Eigen::Vector3d(0, 0.6, 0.8));
  EXPECT_EQ(camera[0].field_of_view, 0.1);
  const auto splits = reader.rows<SplitRow>();
  ASSERT_EQ(splits.size(), 2u);
  EXPECT_EQ(splits[0].to, 2);
  EXPECT_EQ(splits[1].to, -1);
  EXPECT_EQ(splits[0].voxel, (std::array<std::int32_t, 3>{3, -4, 5}));
  const auto procedures = reader.rows<ProcedureRow>();
  ASSERT_EQ(procedures.size(), 1u);
  EXPECT_EQ(procedures[0].emptied, 3u);
  EXPECT_EQ(procedures[0].fallen, 9.5);
  EXPECT_EQ(procedures[0].checksum, ~std::uint64_t{0});
}

TEST(DrillingRecordTest, TheBoneIsThereFromTheBeginning) {
  const TemporaryFolder folder;
  BoneRecord second = test::small_bone();
  second.bone.bone = 1;
  second.bone.name = "other";
  for (auto& row : second.structures) {
    row.bone = 1;
  }
  for (auto& row : second.runs) {
    row.bone = 1;
  }
  for (auto& row : second.densities) {
    row.bone = 1;
  }
  const SessionWriter writer(folder / "a.h5", test::example_info(), drilling_tables(),
                             rows_of(std::vector<BoneRecord>{test::small_bone(), second}));
  const auto bones = recorded_bones(SessionReader(folder / "a.h5.partial"));
  ASSERT_EQ(bones.size(), 2u);
  const BoneRecord given = test::small_bone();
  EXPECT_EQ(bones[0].bone.name, given.bone.name);
  EXPECT_EQ(bones[0].bone.size, given.bone.size);
  EXPECT_EQ(bones[0].bone.origin, given.bone.origin);
  EXPECT_EQ(bones[0].bone.spacing, given.bone.spacing);
  ASSERT_EQ(bones[0].structures.size(), 2u);
  EXPECT_EQ(bones[0].structures[1].name, "nerve");
  EXPECT_TRUE(bones[0].structures[1].vital);
  EXPECT_EQ(bones[0].structures[1].hardness, 0.5);
  ASSERT_EQ(bones[0].runs.size(), 2u);
  EXPECT_EQ(bones[0].runs[1].first, 23u);
  ASSERT_EQ(bones[0].densities.size(), 1u);
  EXPECT_EQ(bones[0].densities[0].density, 0.25F);
  EXPECT_EQ(bones[1].bone.name, "other");
  EXPECT_EQ(bones[1].runs.size(), 2u);
}

TEST(DrillingRecordTest, OtherSessionsHaveNoneOfIt) {
  const TemporaryFolder folder;
  SessionWriter writer(folder / "a.h5", test::example_info());
  EXPECT_THROW(add<ToolRow>(writer, test::tool_motion(1, 1)), std::invalid_argument);
  writer.close();
  const SessionReader reader(folder / "a.h5");
  EXPECT_FALSE(drills(reader));
  EXPECT_TRUE(reader.rows<ToolRow>().empty());
  EXPECT_TRUE(recorded_bones(reader).empty());
}

TEST(DrillingRecordTest, NoTwoTablesHaveChunksOfOneSize) {
  EXPECT_NO_THROW(check_chunk_sizes(drilling_tables()));
  const Table<RemovalRow> twin(
      {"twin", "as long as a row of /runs",
       runs_table().schema().chunk_rows * runs_table().schema().row_bytes() / 8},
      {Table<RemovalRow>::column("sequence", &RemovalRow::sequence, "1", "of the tick")});
  try {
    check_chunk_sizes({&twin});
    FAIL() << "two tables with chunks of one size were taken";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("/twin"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("/runs"), std::string::npos) << error.what();
  }
}

/// The same bytes as the file of a writer that was killed.
fs::path copy_of_partial(const TemporaryFolder& folder) {
  fs::create_directory(folder / "killed");
  fs::copy_file(folder / "a.h5.partial", folder / "killed" / "a.h5.partial");
  return folder / "killed" / "a.h5";
}

TEST(DrillingRecordTest, AfterAKillEveryTableEndsWithTheSameTickAndGoesOn) {
  for (const std::uint64_t ticks : {1000u, 767u, 2304u, 5000u}) {
    const TemporaryFolder folder;
    fs::path killed;
    {
      SessionWriter writer(folder / "a.h5", live_info(), drilling_tables(),
                           rows_of(std::vector{test::small_bone()}));
      drill(writer, 0, ticks);
      writer.flush();
      killed = copy_of_partial(folder);
    }
    Resumed found;
    SessionWriter writer = SessionWriter::resume(killed, found, test::drilling_and_common());
    EXPECT_LE(ticks - found.next_sequence, 768u);
    drill(writer, found.next_sequence, 9000);
    writer.add_pass({1, "drilling", kDrillingPhase, 1, 1, 7, 0, 8999, PassStatus::kCompleted});
    writer.set_timing({}, {9000 - found.next_sequence, 0, 0});
    writer.close();
    const SessionReader reader(killed);
    const Integrity integrity = check_session(reader, test::drilling_and_common());
    EXPECT_TRUE(integrity.ok) << integrity.problems.front();
    const std::vector<ToolRow> given = test::tool_motion(9000, 4);
    const std::vector<ToolRow> tool = reader.rows<ToolRow>();
    ASSERT_EQ(tool.size(), 9000u);
    for (std::size_t i = 0; i < tool.size(); ++i) {
      ASSERT_EQ(tool[i].sequence, i);
    }
    const auto removals = reader.rows<RemovalRow>();
    std::uint64_t next = 0;
    for (const RemovalRow& row : removals) {
      ASSERT_GE(row.sequence, next);
      next = row.sequence + 1;
    }
    // A removal is on every tenth tick from where each run began.
    EXPECT_EQ(removals.size(),
              (found.next_sequence + 9) / 10 + (9000 - found.next_sequence + 9) / 10);
    EXPECT_EQ(recorded_bones(reader).size(), 1u);
    EXPECT_EQ(reader.passes().front().phase, kDrillingPhase);
  }
}

TEST(DrillingRecordTest, AFileThatLostItsHeaderGivesItsDrillingBack) {
  const TemporaryFolder folder;
  {
    SessionWriter writer(folder / "a.h5", test::example_info(), drilling_tables(),
                         rows_of(std::vector{test::small_bone()}));
    drill(writer, 0, 9000);
    add<CameraRow>(writer, {{7, 3, {1, 2, 3}, {4, 5, 6}, {0, 1, 0}, 0.1}});
    add<SplitRow>(writer, {{9, 1, 2, {3, 4, 5}}});
    add<ProcedureRow>(writer, {{0, 0, 1, 3, 4, 5, 6, 7, 8, 9, 10}});
    writer.add_pass({1, "drilling", kDrillingPhase, 1, 1, 7, 0, 8999, PassStatus::kCompleted});
    writer.set_timing({}, {9000, 0, 0});
    writer.close();
  }
  std::string bytes = file_text(folder / "a.h5");
  std::fill_n(bytes.begin(), 2048, '\0');
  std::ofstream(folder / "torn.h5", std::ios::binary) << bytes;
  EXPECT_THROW(SessionReader(folder / "torn.h5"), InputError);
  recover_session(folder / "torn.h5", folder / "saved.h5", test::drilling_and_common());
  const SessionReader whole(folder / "a.h5");
  const SessionReader saved(folder / "saved.h5");
  ASSERT_TRUE(drills(saved));
  EXPECT_EQ(saved.sample_count(), 9000u);
  const auto tool = whole.rows<ToolRow>();
  const auto found = saved.rows<ToolRow>();
  ASSERT_EQ(found.size(), tool.size());
  for (std::size_t i = 0; i < tool.size(); i += 97) {
    expect_same(tool[i], found[i]);
  }
  EXPECT_EQ(saved.count<RemovalRow>(), whole.count<RemovalRow>());
  EXPECT_EQ(saved.count<CameraRow>(), 1u);
  EXPECT_EQ(saved.count<SplitRow>(), 1u);
  EXPECT_EQ(saved.rows<ProcedureRow>().front().checksum, 10u);
  ASSERT_EQ(recorded_bones(saved).size(), 1u);
  EXPECT_EQ(recorded_bones(saved).front().runs.size(), 2u);
}

}  // namespace
}  // namespace haptrial::record::drilling_record_test
