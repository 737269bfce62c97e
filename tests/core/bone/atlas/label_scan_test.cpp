// Ears that are registered to a made ear which was turned, moved and warped: its labels are known
// exactly. elastix does the registration.

#include "core/bone/atlas/label_scan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/bone/atlas/compare_labels.h"
#include "core/bone/data/procedural_bone.h"

namespace haptrial::bone::label_scan_test {
namespace {

constexpr RegistrationOptions kQuick{.iterations = 25, .threads = 2};

BoneModel made_ear(std::uint64_t seed) {
  BoneModel ear = make_temporal_bone({.seed = seed, .spacing = 1e-3});
  ear.name = "ear " + std::to_string(seed);
  return ear;
}

/// Place in the ear of a place in the scan: turned by 6 degrees, moved by 4 mm, and bent by 1.5 mm
/// over 40 mm.
Eigen::Vector3d place_in_ear(const Eigen::Vector3d& p, const Eigen::Vector3d& middle) {
  const Eigen::AngleAxisd turn(0.105, Eigen::Vector3d(1.0, 2.0, -1.0).normalized());
  const Eigen::Vector3d bent =
      1.5e-3 *
      Eigen::Vector3d(std::sin(p.y() / 6.4e-3), std::sin(p.z() / 6.4e-3), std::sin(p.x() / 6.4e-3));
  return middle + turn * (p - middle) + Eigen::Vector3d(3e-3, -2e-3, 2e-3) + bent;
}

BoneModel warped(const BoneModel& ear) {
  BoneModel scan = ear;
  scan.labels.assign(ear.labels.size(), 0);
  scan.density.assign(ear.labels.size(), 0.0F);
  const auto& size = ear.grid.size;
  const Eigen::Vector3d middle = ear.grid.centre(size[0] / 2, size[1] / 2, size[2] / 2);
  std::size_t at = 0;
  for (int k = 0; k < size[2]; ++k) {
    for (int j = 0; j < size[1]; ++j) {
      for (int i = 0; i < size[0]; ++i, ++at) {
        const Eigen::Vector3d from =
            (place_in_ear(ear.grid.centre(i, j, k), middle) - ear.grid.origin) / ear.grid.spacing;
        const Eigen::Vector3i voxel = from.array().round().cast<int>();
        if ((voxel.array() >= 0).all() && voxel.x() < size[0] && voxel.y() < size[1] &&
            voxel.z() < size[2]) {
          const std::size_t there = ear.grid.index(voxel);
          scan.labels[at] = ear.labels[there];
          scan.density[at] =
              ear.density.empty() ? (ear.labels[there] != 0 ? 1.0F : 0.0F) : ear.density[there];
        }
      }
    }
  }
  return scan;
}

/// An ear as a CT shows it: bone of some density, and nothing where there is soft tissue.
BoneModel as_scanned(const BoneModel& truth) {
  BoneModel scan = truth;
  for (std::size_t at = 0; at < scan.labels.size(); ++at) {
    const Structure& structure = truth.structures[scan.labels[at]];
    const bool bone = structure.hardness >= 1.0 && structure.name != "bony labyrinth";
    scan.labels[at] = scan.labels[at] != 0 && bone ? 1 : 0;
    scan.density[at] = scan.labels[at] != 0 ? scan.density[at] : 0.0F;
  }
  scan.structures.resize(2);
  scan.name = "scan";
  return scan;
}

std::uint8_t label_of(const BoneModel& model, const std::string& name) {
  for (std::size_t label = 1; label < model.structures.size(); ++label) {
    if (model.structures[label].name == name) {
      return static_cast<std::uint8_t>(label);
    }
  }
  return 0;
}

LabelMatch match_of(const BoneModel& model, const BoneModel& truth, const std::string& name,
                    std::optional<double> margin = {}) {
  const std::uint8_t label = label_of(model, name);
  const auto match = label == 0 ? std::nullopt : compare_label(model, label, truth, margin);
  EXPECT_TRUE(match) << name;
  return match.value_or(LabelMatch{});
}

const std::vector<std::string> kLarge{"bony labyrinth", "internal auditory canal",
                                      "sigmoid sinus and dura", "external auditory canal"};

TEST(LabelScanTest, AWarpedEarGetsItsOwnLabelsBack) {
  const BoneModel ear = made_ear(2);
  const BoneModel truth = warped(ear);
  BoneModel scan = as_scanned(truth);
  const CarriedLabels carried = label_scan(scan, EarSide::kRight, {ear}, kQuick);
  ASSERT_EQ(carried.correlations.size(), 1U);
  EXPECT_GT(carried.correlations[0], 0.8);
  for (const std::string& name : kLarge) {
    EXPECT_LT(match_of(ear, truth, name).dice, 0.4) << name;
    const LabelMatch match = match_of(scan, truth, name);
    EXPECT_GT(match.dice, 0.8) << name;
    EXPECT_LT(match.distance.value_or(1.0), 0.3e-3) << name;
  }
  EXPECT_GT(match_of(scan, truth, "facial nerve").dice, 0.7);
}

TEST(LabelScanTest, EarsOfEitherSideLabelAnotherEar) {
  const BoneModel truth = warped(made_ear(2));
  BoneModel scan = as_scanned(truth);
  const CarriedLabels carried =
      label_scan(scan, EarSide::kRight, {made_ear(3), mirrored(made_ear(4)), made_ear(5)}, kQuick);
  for (const std::string& name : kLarge) {
    EXPECT_GT(match_of(scan, truth, name).dice, 0.6) << name;
  }
  const std::uint8_t nerve = label_of(scan, "facial nerve");
  const auto found = std::ranges::find(carried.structures, nerve, &CarriedStructure::label);
  ASSERT_NE(found, carried.structures.end());
  ASSERT_TRUE(found->margin);
  EXPECT_GT(match_of(scan, truth, "facial nerve", found->margin).held.value_or(0.0), 0.85);
  EXPECT_NE(scan.source.find("labels of 3 registered ears"), std::string::npos) << scan.source;
}

// Two processes that run beside each other find the same for the same ear, to the voxel.
TEST(LabelScanTest, AnEarGivesTheSameLabelsEachTime) {
  const BoneModel ear = make_temporal_bone({.seed = 3, .spacing = 2e-3});
  BoneModel scan = as_scanned(make_temporal_bone({.seed = 2, .spacing = 2e-3}));
  const CarriedLabels carried =
      label_scan(scan, EarSide::kRight, {ear, ear}, {.iterations = 10, .threads = 2});
  EXPECT_EQ(carried.correlations.at(0), carried.correlations.at(1));
  for (const CarriedStructure& one : carried.structures) {
    EXPECT_EQ(one.margin, 0.0) << scan.structures[one.label].name;
  }
}

TEST(LabelScanTest, WithoutElastixOneSentenceSaysWhatToInstall) {
  const std::string path = std::getenv("PATH");
  setenv("PATH", "/nowhere", 1);
  BoneModel scan = made_ear(2);
  const std::vector<BoneModel> ears{scan};
  try {
    label_scan(scan, EarSide::kRight, ears, kQuick);
    ADD_FAILURE() << "nothing was refused";
  } catch (const RunError& error) {
    EXPECT_NE(std::string(error.what()).find("install Debian's package elastix"), std::string::npos)
        << error.what();
  }
  setenv("PATH", path.c_str(), 1);
}

TEST(LabelScanTest, AnEarWithoutASideIsRefused) {
  BoneModel scan = made_ear(2);
  EXPECT_THROW(label_scan(scan, EarSide::kRight, {as_scanned(scan)}, kQuick), InputError);
}

}  // namespace
}  // namespace haptrial::bone::label_scan_test
