// Files that programs of every schema version wrote are read as h5py reads them. The texts beside
// them come from dump_session.py.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>

#include "core/bone/record/drilling_tables.h"
#include "core/record/read/integrity.h"
#include "core/record/read/session_reader.h"
#include "core/record/recovery/recover.h"
#include "tests/core/record/session_fixture.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::record {
namespace {

namespace fs = std::filesystem;

/// A row as h5py has it: column -> text, reals in hexadecimal.
class Dumped {
 public:
  explicit Dumped(const std::string& line) {
    std::istringstream in(line.substr(line.find('|') + 1));
    for (std::string cell; std::getline(in, cell, '|');) {
      const std::size_t equals = cell.find('=');
      values_[cell.substr(0, equals)] = cell.substr(equals + 1);
    }
  }
  bool has(const std::string& column) const { return values_.contains(column); }
  std::string text(const std::string& column) const { return values_.at(column); }
  double real(const std::string& column) const {
    return std::strtod(values_.at(column).c_str(), nullptr);
  }
  std::int64_t i(const std::string& column) const {
    return std::strtoll(values_.at(column).c_str(), nullptr, 10);
  }
  std::uint64_t u(const std::string& column) const {
    return std::strtoull(values_.at(column).c_str(), nullptr, 10);
  }

 private:
  std::map<std::string, std::string> values_;
};

struct Dump {
  std::int64_t version{0};
  std::map<std::string, std::size_t> counts;
  std::map<std::string, std::vector<Dumped>> rows;
};

Dump dump_of(const std::string& name) {
  Dump dump;
  std::ifstream in(HAPTRIAL_SOURCE_DIR "/tests/core/record/data/" + name + ".txt");
  for (std::string line; std::getline(in, line);) {
    const std::string table = line.substr(0, line.find('|'));
    const std::string rest = line.substr(line.find('|') + 1);
    if (table == "schema_version") {
      dump.version = std::strtoll(rest.c_str(), nullptr, 10);
    } else if (rest.find('=') == std::string::npos) {
      dump.counts[table] = std::strtoull(rest.c_str(), nullptr, 10);
    } else {
      dump.rows[table].emplace_back(line);
    }
  }
  return dump;
}

void expect_vector(const Eigen::Vector3d& found, const Dumped& row, const std::string& name) {
  EXPECT_EQ(found.x(), row.real(name + "_x"));
  EXPECT_EQ(found.y(), row.real(name + "_y"));
  EXPECT_EQ(found.z(), row.real(name + "_z"));
}

void expect_same(const Sample& found, const Dumped& row) {
  EXPECT_EQ(found.sequence, row.u("sequence"));
  EXPECT_EQ(found.time_ns, row.i("time_ns"));
  EXPECT_EQ(found.pass, row.i("pass"));
  EXPECT_EQ(static_cast<std::int64_t>(found.stage), row.i("stage"));
  expect_vector(found.position, row, "position");
  expect_vector(found.velocity, row, "velocity");
  expect_vector(found.force, row, "force");
  EXPECT_EQ(found.applied_force, row.real("applied_force"));
  EXPECT_EQ(found.target_force, row.real("target_force"));
  EXPECT_EQ(found.saturated, row.i("saturated") != 0);
}

/// Checks the facts of a pass when it begins; also in /begun.
void expect_begun(const PassRow& found, const Dumped& row) {
  EXPECT_EQ(found.trial, row.i("trial"));
  EXPECT_EQ(found.condition, row.text("condition"));
  EXPECT_EQ(name_of(found.phase), row.text("phase"));
  EXPECT_EQ(found.block, row.i("block"));
  EXPECT_EQ(found.repetition, row.i("repetition"));
  EXPECT_EQ(found.stimulus_seed, row.u("stimulus_seed"));
  EXPECT_EQ(found.practice, row.has("practice") && row.i("practice") != 0);
  EXPECT_EQ(found.attempt, row.has("attempt") ? row.i("attempt") : 1);
}

void expect_same(const PassRow& found, const Dumped& row) {
  expect_begun(found, row);
  EXPECT_EQ(found.first_sample, row.u("first_sample"));
  EXPECT_EQ(found.last_sample, row.u("last_sample"));
  EXPECT_EQ(found.status == PassStatus::kCompleted, row.text("status") == "completed");
}

void expect_same(const BegunRow& found, const Dumped& row) {
  EXPECT_EQ(found.row, row.i("pass"));
  expect_begun(found.pass, row);
}

void expect_same(const RunRow& found, const Dumped& row) {
  EXPECT_EQ(found.run, row.i("run"));
  EXPECT_EQ(found.first_sample, row.u("first_sample"));
  EXPECT_EQ(found.counts.ticks, row.u("ticks"));
  EXPECT_EQ(found.counts.overruns, row.u("overruns"));
  EXPECT_EQ(found.counts.dropped, row.u("dropped"));
  EXPECT_EQ(found.planned, row.i("planned"));
  EXPECT_EQ(name_of(found.state), row.text("state"));
}

void expect_same(const StimulusRow& found, const Dumped& row) {
  EXPECT_EQ(found.block, row.i("block"));
  EXPECT_EQ(found.time, row.real("time"));
  expect_vector(found.position, row, "position");
  EXPECT_EQ(found.force, row.real("force"));
}

void expect_same(const FrameRow& found, const Dumped& row) {
  EXPECT_EQ(found.time_ns, row.i("time_ns"));
  EXPECT_EQ(found.frame_time_ns, row.i("frame_time_ns"));
  EXPECT_EQ(found.dropped, row.i("dropped"));
}

void expect_same(const TimingRow& found, const Dumped& row) {
  EXPECT_EQ(found.bin_low_ns, row.i("bin_low_ns"));
  EXPECT_EQ(found.bin_high_ns, row.i("bin_high_ns"));
  EXPECT_EQ(found.period_count, row.u("period_count"));
  EXPECT_EQ(found.lateness_count, row.u("lateness_count"));
  EXPECT_EQ(found.compute_count, row.u("compute_count"));
}

void expect_same(const ToolRow& found, const Dumped& row) {
  EXPECT_EQ(found.sequence, row.u("sequence"));
  EXPECT_EQ(found.orientation.w(), row.real("orientation_w"));
  EXPECT_EQ(found.orientation.x(), row.real("orientation_x"));
  EXPECT_EQ(found.orientation.y(), row.real("orientation_y"));
  EXPECT_EQ(found.orientation.z(), row.real("orientation_z"));
  EXPECT_EQ(found.buttons, static_cast<std::uint32_t>(row.i("buttons")));
  EXPECT_EQ(found.keys, static_cast<std::uint32_t>(row.i("keys")));
  EXPECT_EQ(found.pedal, row.real("pedal"));
  EXPECT_EQ(found.tool, row.i("tool"));
  EXPECT_EQ(found.mode, row.u("mode"));
  EXPECT_EQ(found.active, row.i("active") != 0);
  EXPECT_EQ(found.power, row.i("power") != 0);
  EXPECT_EQ(found.piece, row.i("piece"));
  EXPECT_EQ(found.immersed, row.i("immersed"));
  EXPECT_EQ(found.removed, row.real("removed"));
  expect_vector(found.contact, row, "contact");
}

template <class Row>
void expect_voxel(const Row& found, const Dumped& row) {
  EXPECT_EQ(found.voxel[0], row.i("i"));
  EXPECT_EQ(found.voxel[1], row.i("j"));
  EXPECT_EQ(found.voxel[2], row.i("k"));
}

void expect_same(const RemovalRow& found, const Dumped& row) {
  EXPECT_EQ(found.sequence, row.u("sequence"));
  EXPECT_EQ(found.piece, row.i("piece"));
  expect_voxel(found, row);
  EXPECT_EQ(found.label, row.u("label"));
  EXPECT_EQ(found.force, row.real("force"));
  EXPECT_EQ(found.speed, row.real("speed"));
}

void expect_same(const CameraRow& found, const Dumped& row) {
  EXPECT_EQ(found.sequence, row.u("sequence"));
  EXPECT_EQ(found.time_ns, row.i("time_ns"));
  expect_vector(found.eye, row, "eye");
  expect_vector(found.target, row, "target");
  expect_vector(found.up, row, "up");
  EXPECT_EQ(found.field_of_view, row.real("field_of_view"));
}

void expect_same(const SplitRow& found, const Dumped& row) {
  EXPECT_EQ(found.sequence, row.u("sequence"));
  EXPECT_EQ(found.from, row.i("from"));
  EXPECT_EQ(found.to, row.i("to"));
  expect_voxel(found, row);
}

void expect_same(const BoneRow& found, const Dumped& row) {
  EXPECT_EQ(found.bone, row.i("bone"));
  EXPECT_EQ(found.name, row.text("name"));
  EXPECT_EQ(found.source, row.text("source"));
  EXPECT_EQ(found.size[0], row.i("size_x"));
  EXPECT_EQ(found.size[1], row.i("size_y"));
  EXPECT_EQ(found.size[2], row.i("size_z"));
  expect_vector(found.origin, row, "origin");
  EXPECT_EQ(found.spacing, row.real("spacing"));
}

void expect_same(const StructureRow& found, const Dumped& row) {
  EXPECT_EQ(found.bone, row.i("bone"));
  EXPECT_EQ(found.label, row.i("label"));
  EXPECT_EQ(found.name, row.text("name"));
  EXPECT_EQ(found.colour[0], row.real("red"));
  EXPECT_EQ(found.colour[1], row.real("green"));
  EXPECT_EQ(found.colour[2], row.real("blue"));
  EXPECT_EQ(found.hardness, row.real("hardness"));
  EXPECT_EQ(found.vital, row.i("vital") != 0);
}

void expect_same(const BoneRunRow& found, const Dumped& row) {
  EXPECT_EQ(found.bone, row.i("bone"));
  EXPECT_EQ(found.first, row.u("first"));
  EXPECT_EQ(found.count, row.i("count"));
  EXPECT_EQ(found.label, row.u("label"));
}

void expect_same(const BoneDensityRow& found, const Dumped& row) {
  EXPECT_EQ(found.bone, row.i("bone"));
  EXPECT_EQ(found.voxel, row.u("voxel"));
  EXPECT_EQ(static_cast<double>(found.density), row.real("density"));
}

void expect_same(const ProcedureRow& found, const Dumped& row) {
  EXPECT_EQ(found.pass, row.i("pass"));
  EXPECT_EQ(found.bone, row.i("bone"));
  EXPECT_EQ(found.pieces, row.i("pieces"));
  EXPECT_EQ(found.emptied, row.u("emptied"));
  EXPECT_EQ(found.before, row.real("before"));
  EXPECT_EQ(found.left, row.real("left"));
  EXPECT_EQ(found.cut, row.real("cut"));
  EXPECT_EQ(found.dust, row.real("dust"));
  EXPECT_EQ(found.suctioned, row.real("suctioned"));
  EXPECT_EQ(found.fallen, row.real("fallen"));
  EXPECT_EQ(found.checksum, row.u("checksum"));
}

template <class Row>
void expect_rows(const std::vector<Row>& found, Dump& dump, const std::string& table) {
  SCOPED_TRACE(table);
  ASSERT_EQ(found.size(), dump.counts[table]);
  for (std::size_t i = 0; i < dump.rows[table].size(); ++i) {
    expect_same(found[i], dump.rows[table][i]);
  }
}

void expect_contents(const SessionReader& reader, Dump& dump) {
  expect_rows(reader.samples(0, reader.sample_count()), dump, "samples");
  expect_rows(reader.frames(), dump, "frames");
  expect_rows(reader.passes(), dump, "trials");
  expect_rows(reader.stimuli(), dump, "stimuli");
  expect_rows(reader.begun(), dump, "begun");
  expect_rows(reader.rows<ToolRow>(), dump, "tool");
  expect_rows(reader.rows<RemovalRow>(), dump, "removals");
  expect_rows(reader.rows<CameraRow>(), dump, "camera");
  expect_rows(reader.rows<SplitRow>(), dump, "splits");
  expect_rows(reader.rows<BoneRow>(), dump, "bones");
  expect_rows(reader.rows<StructureRow>(), dump, "structures");
  expect_rows(reader.rows<BoneRunRow>(), dump, "bone_runs");
  expect_rows(reader.rows<BoneDensityRow>(), dump, "bone_densities");
  expect_rows(reader.rows<ProcedureRow>(), dump, "procedures");
}

class OldVersionTest : public testing::TestWithParam<const char*> {
 protected:
  fs::path file_{HAPTRIAL_SOURCE_DIR "/tests/core/record/data/" + std::string(GetParam()) +
                 ".hdf5"};
  Dump dump_{dump_of(GetParam())};
};

TEST_P(OldVersionTest, IsReadAsItWasWritten) {
  const SessionReader reader(file_);
  EXPECT_EQ(reader.version(), dump_.version);
  ASSERT_GT(dump_.counts["samples"], 0u);
  expect_contents(reader, dump_);
  expect_rows(reader.runs(), dump_, "runs");
  expect_rows(reader.timing(), dump_, "timing");
  const Integrity integrity = check_session(reader, test::drilling_and_common());
  EXPECT_EQ(integrity.rows, dump_.counts["samples"]);
}

TEST_P(OldVersionTest, IsRecoveredInThePresentLayout) {
  const test::TemporaryFolder folder;
  recover_session(file_, folder / "out.h5", test::drilling_and_common());
  const SessionReader reader(folder / "out.h5");
  EXPECT_EQ(reader.version(), kSchemaVersion);
  // Recovered in the order of their times; the file has two runs of them whose times overlap.
  std::vector<FrameRow> frames = reader.frames();
  EXPECT_TRUE(std::ranges::is_sorted(frames, {}, &FrameRow::time_ns));
  for (const Dumped& row : dump_.rows["frames"]) {
    EXPECT_TRUE(std::ranges::any_of(frames, [&](const FrameRow& found) {
      return found.time_ns == row.i("time_ns") && found.frame_time_ns == row.i("frame_time_ns") &&
             found.dropped == row.i("dropped");
    }));
  }
  dump_.rows["frames"].clear();
  expect_contents(reader, dump_);
}

INSTANTIATE_TEST_SUITE_P(Versions, OldVersionTest,
                         testing::Values("version1", "version2", "version3", "version3_drilling",
                                         "version4", "version4_drilling"),
                         [](const auto& each) { return std::string(each.param); });

}  // namespace
}  // namespace haptrial::record
