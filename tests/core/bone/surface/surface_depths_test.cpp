#include "core/bone/surface/surface_depths.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/base/random.h"
#include "tests/core/bone/surface/surface_checks.h"

namespace haptrial::bone {
namespace {

TEST(SurfaceDepthsTest, TheNearestStructureIsTheOneThatATryOfAllFinds) {
  RandomStream random(5, "depths");
  std::vector<Voxel> structures;
  BoneModel model = model_of(30, [&](const Voxel& voxel) {
    if (random.uniform() < 0.002) {
      structures.push_back(voxel);
      return 2;
    }
    return 1;
  });
  constexpr double kReach = 0.0052;
  const StructureDepths depths(model, {false, false, true}, kReach);
  int near = 0;
  int none = 0;
  for (int k = 0; k < 30; ++k) {
    for (int j = 0; j < 30; ++j) {
      for (int i = 0; i < 30; ++i) {
        double least = 1e9;
        for (const Voxel& s : structures) {
          least = std::min(least, 0.001 * (s - Voxel(i, j, k)).cast<double>().norm());
        }
        const NearStructure found = depths.at({i, j, k});
        if (least <= kReach) {
          ASSERT_EQ(found.label, 2);
          ASSERT_NEAR(found.distance, least, 1e-12);
          ++near;
        } else {
          ASSERT_EQ(found.label, 0);
          ++none;
        }
      }
    }
  }
  EXPECT_GT(near, 1000);
  EXPECT_GT(none, 1000);
  EXPECT_EQ(depths.at({-1, 3, 3}).label, 0);
  EXPECT_EQ(depths.at({30, 3, 3}).label, 0);
}

TEST(SurfaceDepthsTest, OfTwoAsNearTheLowerLabelCountsAndBoneNeverDoes) {
  const BoneModel model = model_of(9, [](const Voxel& voxel) {
    return voxel == Voxel(2, 4, 4) ? 2 : voxel == Voxel(6, 4, 4) ? 1 : 0;
  });
  const StructureDepths both(model, {false, true, true}, 0.01);
  EXPECT_EQ(both.at({4, 4, 4}).label, 1);
  EXPECT_EQ(both.at({3, 4, 4}).label, 2);
  const StructureDepths one(model, all_but_bone(model.structures), 0.01);
  EXPECT_EQ(one.at({6, 4, 4}).label, 2);
  EXPECT_DOUBLE_EQ(one.at({6, 4, 4}).distance, 0.004);
  EXPECT_EQ(StructureDepths(model, {}, 0.01).at({4, 4, 4}).label, 0);
}

/// A structure beside a brick without bone; far away is bone that has nothing within reach.
TEST(SurfaceDepthsTest, WhatLiesBesideAnEmptyBrickDoesNotShowElsewhere) {
  const BoneModel model = model_of(40, [](const Voxel& voxel) {
    return voxel == Voxel(7, 7, 7) ? 2 : voxel.minCoeff() >= 32 ? 1 : 0;
  });
  const StructureDepths depths(model, all_but_bone(model.structures), 0.005);
  EXPECT_EQ(depths.at({7, 7, 6}).label, 2);
  for (int k = 32; k < 40; ++k) {
    for (int j = 32; j < 40; ++j) {
      for (int i = 32; i < 40; ++i) {
        ASSERT_EQ(depths.at({i, j, k}).label, 0);
      }
    }
  }
}

TEST(SurfaceDepthsTest, BoneIsToldByItsName) {
  const std::vector<Structure> structures{{""}, {"bone"}, {"cortical bone"}, {"facial nerve"}};
  EXPECT_EQ(all_but_bone(structures), (std::vector<bool>{false, false, false, true}));
}

TEST(SurfaceDepthsTest, AReachThatIsNoReachIsRefused) {
  const BoneModel model = ball_model(4, 1.0);
  EXPECT_THROW(StructureDepths(model, {}, -0.001), std::invalid_argument);
  EXPECT_THROW(StructureDepths(model, {}, 0.26), std::invalid_argument);
  EXPECT_THROW(StructureDepths(model, {}, std::nan("")), std::invalid_argument);
}

}  // namespace
}  // namespace haptrial::bone
