// "From a scan to a case": every command of the guide, on a DICOM series and a segmentation of a
// made ear, and the heads of people up to where they need no segmentation.
//   HAPTRIAL_KEEP_PICTURES=docs/images build/test_experiments --gtest_filter='ScanGuideTest.*'
// makes the guide's pictures.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>

#include "core/bone/data/bone_summary.h"
#include "core/bone/data/load_bone.h"
#include "core/bone/data/procedural_bone.h"
#include "core/bone/record/drilling_tables.h"
#include "core/bone/surface/surface_mesh.h"
#include "core/geometry/files/mesh_io.h"
#include "core/record/read/session_reader.h"
#include "tests/core/bone/data/volume_bytes.h"
#include "tests/experiments/command.h"
#include "tests/experiments/shipped.h"
#include "tests/support/dicom_series.h"
#include "tests/support/shared_data.h"
#include "tests/support/temporary_folder.h"

namespace haptrial {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// The commands of the guide, in its order.
std::vector<std::string> commands() {
  std::istringstream page(
      test::read_text(fs::path(HAPTRIAL_SOURCE_DIR) / "docs" / "guide-scan.md"));
  std::vector<std::string> found;
  for (std::string line; std::getline(page, line);) {
    if (line.starts_with("haptrial ")) {
      found.push_back(line);
    }
  }
  return found;
}

void edit(const fs::path& file, const std::string& line, const std::string& by) {
  const std::string text = test::read_text(file);
  const std::string edited =
      std::regex_replace(text, std::regex("(^|\n)" + line + "[^\n]*"), "$1" + by);
  ASSERT_NE(edited, text) << line;
  test::write_text(file, edited);
}

class ScanGuideTest : public testing::Test {
 protected:
  void run(const std::string& line) {
    const auto result = test::run_command("cd '" + folder_.path().string() + "'\n" + line);
    EXPECT_EQ(result.status, 0) << line << "\n" << result.output << result.errors;
    output_ += result.output;
  }
  /// Writes the files of a clinic: a scan, a segmentation in two layers, a mesh of the nerve.
  void write_scan() {
    ear_ = bone::make_temporal_bone({.seed = 5, .spacing = 0.8e-3});
    const geometry::VoxelGrid& grid = ear_.grid;
    test::DicomSeries series;
    series.size = grid.size;
    series.step = Eigen::Vector3d::Constant(1e3 * grid.spacing);
    series.origin = 1e3 * grid.origin;
    series.value = [this](int i, int j, int k) { return hounsfield(ear_.grid.index(i, j, k)); };
    test::write_dicom(folder_ / "series", series);
    write_segments();
    geometry::Mesh nerve = bone::structure_mesh(ear_, label_named("facial nerve"));
    for (Eigen::Vector3d& vertex : nerve.vertices) {
      vertex *= 1e3;
    }
    geometry::write_mesh(folder_ / "nerve.stl", nerve);
  }
  int hounsfield(std::size_t at) const {
    const std::uint8_t label = ear_.labels[at];
    const double density = ear_.density.empty() ? 1.0 : static_cast<double>(ear_.density[at]);
    return label == 0 ? -1000 : label == 1 ? 300 + static_cast<int>(1200.0 * density) : 40;
  }
  std::uint8_t label_named(const std::string& name) const {
    const auto found = std::ranges::find(ear_.structures, name, &bone::Structure::name);
    EXPECT_NE(found, ear_.structures.end()) << name;
    return static_cast<std::uint8_t>(found - ear_.structures.begin());
  }
  /// Writes segments without plain bone and the nerve; ossicles in a layer of their own, one with a
  /// clinic's name.
  void write_segments() {
    std::string keys;
    int number = 0;
    std::vector<bool> ossicle(256, false);
    std::vector<bool> left_out(256, false);
    left_out[0] = left_out[1] = left_out[label_named("facial nerve")] = true;
    for (std::size_t label = 2; label < ear_.structures.size(); ++label) {
      std::string name = ear_.structures[label].name;
      if (left_out[label] || name.empty()) {
        continue;
      }
      ossicle[label] = name == "malleus" || name == "incus" || name == "stapes";
      name = name == "incus" ? "Incus dexter" : name;
      keys += fmt::format(
          "Segment{0}_ID:=Segment_{0}\nSegment{0}_LabelValue:={1}\n"
          "Segment{0}_Layer:={2}\nSegment{0}_Name:={3}\nSegment{0}_Color:={4} 0.5 "
          "0.4\n",
          number, label, ossicle[label] ? 1 : 0, name, 0.04 * number);
      ++number;
    }
    std::string bytes;
    for (const std::uint8_t label : ear_.labels) {
      const bool kept = !left_out[label];
      bytes += kept && !ossicle[label] ? static_cast<char>(label) : '\0';
      bytes += kept && ossicle[label] ? static_cast<char>(label) : '\0';
    }
    const geometry::VoxelGrid& grid = ear_.grid;
    const double h = 1e3 * grid.spacing;
    const Eigen::Vector3d origin = 1e3 * grid.origin;
    test::write_bytes(folder_ / "ear.seg.nrrd",
                      fmt::format("NRRD0004\ntype: unsigned char\ndimension: 4\n"
                                  "space: left-posterior-superior\nsizes: 2 {} {} {}\n"
                                  "space directions: none ({},0,0) (0,{},0) (0,0,{})\n"
                                  "kinds: list domain domain domain\nencoding: gzip\n"
                                  "space origin: ({},{},{})\n{}\n",
                                  grid.size[0], grid.size[1], grid.size[2], h, h, h, origin.x(),
                                  origin.y(), origin.z(), keys) +
                          test::gzip(bytes));
  }
  void keep_pictures() {
    const char* to = std::getenv("HAPTRIAL_KEEP_PICTURES");
    if (to == nullptr) {
      return;
    }
    for (const auto& entry : fs::directory_iterator(folder_.path())) {
      if (entry.path().extension() == ".png") {
        fs::copy_file(entry.path(), fs::path(to) / ("scan-" + entry.path().filename().string()),
                      fs::copy_options::overwrite_existing);
      }
    }
  }
  test::TemporaryFolder folder_;
  bone::BoneModel ear_;
  std::string output_;
};

TEST_F(ScanGuideTest, EveryCommandLeadsFromTheScanToADrilledBone) {
  write_scan();
  for (const std::string& command : commands()) {
    run(command);
    if (command.starts_with("haptrial new ")) {  // what the guide says to write
      edit(folder_ / "case.toml", "bones = ", "bones = [\"named.nrrd\"]");
      edit(folder_ / "case.toml", "time_limit = ", "time_limit = 20.0");
    }
    if (HasFailure()) {
      return;
    }
  }
  EXPECT_GE(commands().size(), 10U);
  EXPECT_THAT(output_, HasSubstr("Incus dexter"));
  EXPECT_THAT(output_, HasSubstr("nearest known name is 'incus'"));
  keep_pictures();
  const bone::BoneModel named = bone::load_bone(folder_ / "named.nrrd");
  for (const bone::StructureSummary& one : bone::summary_of(named).structures) {
    const bone::Structure& structure = named.structures[one.label];
    const bone::BoneSummary truth = bone::summary_of(ear_);
    const auto before = std::ranges::find(truth.structures, label_named(structure.name),
                                          &bone::StructureSummary::label);
    ASSERT_NE(before, truth.structures.end()) << structure.name;
    const double grain = std::pow(ear_.grid.spacing, 3);
    EXPECT_NEAR(one.volume, before->volume, 0.25 * before->volume + 8.0 * grain) << structure.name;
    EXPECT_LT((one.box.center() - before->box.center()).norm(), 1e-3) << structure.name;
  }
  // Voxels that the exported labels call removed are those that the session emptied.
  const record::SessionReader session(folder_ / "out/case/S01.h5");
  const auto removals = session.rows<record::RemovalRow>();
  const bone::BoneModel drilled = bone::load_bone(folder_ / "drilled.seg.nrrd");
  std::size_t removed = 0;
  for (const std::uint8_t label : drilled.labels) {
    removed += drilled.structures[label].name.starts_with("removed") ? 1 : 0;
  }
  EXPECT_GT(removals.size(), 100U);
  EXPECT_GE(removed, removals.size());  // and crumbs that fell off
  EXPECT_LT(removed, removals.size() + removals.size() / 10 + 10);
  for (const record::RemovalRow& row : removals) {
    const std::size_t at = drilled.grid.index(row.voxel[0], row.voxel[1], row.voxel[2]);
    ASSERT_TRUE(drilled.structures[drilled.labels[at]].name.starts_with("removed"));
  }
}

class ScanGuideHeadTest : public ScanGuideTest, public testing::WithParamInterface<const char*> {};

TEST_P(ScanGuideHeadTest, AHeadIsImportedCroppedAndExported) {
  const auto file = test::shared_data(GetParam());
  if (!file) {
    GTEST_SKIP() << "neither HAPTRIAL_DATA nor ../shared/data holds " << GetParam();
  }
  const std::string name = "'" + file->string() + "'";
  run("haptrial bone import " + name +
      " head.nrrd --threshold auto --spacing 2 --largest --fill "
      "200 --histogram histogram.svg && haptrial bone export head.nrrd head.stl && "
      "haptrial mesh info head.stl");
  EXPECT_THAT(output_, HasSubstr("is suggested"));
  const bone::BoneModel head = bone::load_bone(folder_ / "head.nrrd");
  const Eigen::Vector3d middle = 1e3 * bone::summary_of(head).box.center();
  run(
      fmt::format("haptrial bone import {} part.nrrd --threshold auto --spacing 2 "
                  "--around={:.1f},{:.1f},{:.1f},60",
                  name, middle.x(), middle.y(), middle.z()));
  const bone::BoneModel part = bone::load_bone(folder_ / "part.nrrd");
  for (const std::int32_t size : part.grid.size) {
    EXPECT_LE(size, 31);
  }
}

INSTANTIATE_TEST_SUITE_P(Heads, ScanGuideHeadTest,
                         testing::Values("ct/headsq_quarter_64x64x93.nrrd",
                                         "ct/CT_pitch_175x248x58.nrrd"),
                         [](const auto& head) { return head.index == 0 ? "Coarse" : "Windowed"; });

}  // namespace
}  // namespace haptrial
