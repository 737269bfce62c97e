// Laws of anatomy, held over seeds; numbers as docs/algorithms/procedural-bones.md cites them.

#include "core/bone/data/mandible.h"

#include <gtest/gtest.h>

#include <map>

#include "core/base/error.h"
#include "core/bone/data/bone_summary.h"
#include "tests/core/bone/data/made_bones.h"

namespace haptrial::bone::mandible_test {
namespace {

using test::places_of;

constexpr double kSpacing = 0.8e-3;

const BoneModel& made(std::uint64_t seed) {
  static std::map<std::uint64_t, BoneModel> models;
  const auto found = models.find(seed);
  if (found != models.end()) {
    return found->second;
  }
  return models.emplace(seed, make_mandible({.seed = seed, .spacing = kSpacing})).first->second;
}

TEST(MandibleTest, BoneIsOnePieceWithANerveOnEachSide) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    for (const StructureSummary& one : summary_of(made(seed)).structures) {
      if (one.label == static_cast<int>(Anatomy::kBone)) {
        EXPECT_EQ(one.pieces, 1U) << seed;
      }
      if (one.label == static_cast<int>(Anatomy::kAlveolarNerve)) {
        EXPECT_EQ(one.pieces, 2U) << seed;
      }
    }
  }
}

TEST(MandibleTest, ItIsAsLargeAsMandiblesAre) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    double condyles = 0.0;
    double angles = 0.0;
    double top = 0.0;
    for (const Eigen::Vector3d& p : places_of(made(seed), Anatomy::kBone)) {
      if (p.z() > 60.0) {
        condyles = std::max(condyles, p.x());
      }
      if (p.z() < 22.0 && p.y() > 60.0) {
        angles = std::max(angles, p.x());
      }
      top = std::max(top, p.z());
    }
    EXPECT_NEAR(2.0 * condyles, 118.0, 14.0) << seed;
    EXPECT_NEAR(2.0 * angles, 101.6, 15.0) << seed;
    EXPECT_NEAR(top, 68.0, 10.0) << seed;
    const double volume = summary_of(made(seed)).volume * 1e6;  // [cm3]
    EXPECT_GT(volume, 40.0) << seed;
    EXPECT_LT(volume, 110.0) << seed;
  }
}

TEST(MandibleTest, TheNerveIsCoveredByBoneInTheBodyAndLiesBelowTheRoots) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const BoneModel& model = made(seed);
    const auto nerve = places_of(model, Anatomy::kAlveolarNerve);
    const auto teeth = places_of(model, Anatomy::kTooth);
    EXPECT_GT(test::gap_between(nerve, teeth), 0.9) << seed;
    const geometry::VoxelGrid& grid = model.grid;
    for (const Eigen::Vector3d& p : nerve) {
      if (p.y() < 34.0 || p.y() > 55.0) {
        continue;
      }  // between the foramina
      // Down, in, out and up from it there is bone within 12 mm, before any opening.
      for (const Eigen::Vector3d& way :
           {Eigen::Vector3d(0, 0, -1), Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(-1, 0, 0)}) {
        bool bone = false;
        for (double step = 0.0; step < 12.0 && !bone; step += 0.4) {
          const Eigen::Vector3d at = 1e-3 * (p + step * way);
          const Eigen::Vector3d voxel = (at - grid.origin) / grid.spacing;
          const auto label = model.labels[grid.index(static_cast<int>(std::lround(voxel.x())),
                                                     static_cast<int>(std::lround(voxel.y())),
                                                     static_cast<int>(std::lround(voxel.z())))];
          ASSERT_NE(label, 0) << seed << ": open at " << p.transpose();
          bone = label == static_cast<int>(Anatomy::kBone);
        }
        EXPECT_TRUE(bone);
      }
    }
  }
}

TEST(MandibleTest, CortexIsDenseAndMarrowIsNot) {
  const BoneModel& model = made(1);
  std::size_t dense = 0;
  std::size_t light = 0;
  for (std::size_t i = 0; i < model.labels.size(); ++i) {
    if (model.labels[i] != static_cast<int>(Anatomy::kBone)) {
      continue;
    }
    dense += model.density[i] == 1.0F;
    light += model.density[i] < 0.6F;
  }
  EXPECT_GT(dense, 10000U);
  EXPECT_GT(light, 10000U);
}

TEST(MandibleTest, SidesMirrorSeedsVaryAndThreadsDoNot) {
  const BoneModel one = make_mandible({.seed = 4, .spacing = 2e-3, .threads = 1});
  EXPECT_EQ(one.labels, make_mandible({.seed = 4, .spacing = 2e-3, .threads = 4}).labels);
  EXPECT_NE(one.labels, make_mandible({.seed = 5, .spacing = 2e-3}).labels);
  const auto nerve = places_of(made(1), Anatomy::kAlveolarNerve);
  EXPECT_LT(std::abs(test::middle_of(nerve).x()), 1.0);
  EXPECT_THROW(make_mandible({.spacing = 0.1e-3}), InputError);
}

}  // namespace
}  // namespace haptrial::bone::mandible_test
