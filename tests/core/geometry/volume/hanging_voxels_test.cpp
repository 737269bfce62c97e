#include "core/geometry/volume/hanging_voxels.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/geometry/volume/voxelize.h"

namespace haptrial::geometry {
namespace {

/// A block of 4 x 4 x 4 voxels in a grid of 8 x 8 x 8, and others beside it.
VoxelSolid block_and(const std::vector<std::array<std::int32_t, 3>>& others) {
  VoxelSolid solid{{{8, 8, 8}, Eigen::Vector3d::Zero(), 1.0}, {}};
  solid.labels.assign(solid.grid.count(), VoxelLabel::kOutside);
  for (std::int32_t v = 0; v < 64; ++v) {
    solid.labels[solid.grid.index(v % 4, v / 4 % 4, v / 16)] = VoxelLabel::kInside;
  }
  for (const auto& [i, j, k] : others) {
    solid.labels[solid.grid.index(i, j, k)] = VoxelLabel::kInside;
  }
  return solid;
}

TEST(HangingVoxelsTest, WhatTouchesByAnEdgeOrACornerGoes) {
  VoxelSolid solid = block_and({{4, 4, 0}, {4, 4, 1}, {4, 4, 4}});
  EXPECT_EQ(drop_hanging_voxels(solid), 3u) << "two along an edge, and one beyond them";
  EXPECT_EQ(solid.labels, block_and({}).labels);
}

TEST(HangingVoxelsTest, WhatTwoEdgesHoldStays) {
  VoxelSolid solid = block_and({{4, 4, 0}, {4, 3, 1}, {3, 4, 1}, {4, 2, 1}});
  solid.labels[solid.grid.index(3, 3, 0)] = VoxelLabel::kOutside;
  VoxelSolid before = solid;
  EXPECT_EQ(drop_hanging_voxels(solid), 0u);
  EXPECT_EQ(solid.labels, before.labels);
}

TEST(HangingVoxelsTest, WhatIsJoinedByAFaceOrTouchesNothingStays) {
  for (const auto& others : {std::vector<std::array<std::int32_t, 3>>{{4, 0, 0}, {5, 0, 0}},
                             {{7, 7, 7}, {6, 7, 7}},
                             {{4, 3, 0}, {4, 4, 0}}}) {
    VoxelSolid solid = block_and(others);
    EXPECT_EQ(drop_hanging_voxels(solid), 0u);
    EXPECT_EQ(count_inside(solid), 66u);
  }
}

TEST(HangingVoxelsTest, APartThatIsNoSmallOneIsRefused) {
  VoxelSolid solid = block_and({{4, 4, 0}, {4, 4, 1}, {4, 4, 2}, {4, 4, 3}});
  EXPECT_THROW(drop_hanging_voxels(solid), InputError);
}

}  // namespace
}  // namespace haptrial::geometry
