#include "core/bone/model/tidy.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/solid_bone.h"

namespace haptrial::bone::tidy_test {
namespace {

constexpr int kSize = 20;

/// A block of bone from 3 to 16, with a hole of 2 x 2 x 2, a tunnel to the outside, and beside it a
/// loose voxel of bone and one of nerve.
BoneModel block() {
  BoneModel model = haptrial::test::solid_bone(
      kSize, 1e-3, [](const Eigen::Vector3d& p) { return p.cwiseAbs().maxCoeff() < 7e-3; });
  model.structures.push_back({"facial nerve"});
  const auto at = [&](int i, int j, int k) -> std::uint8_t& {
    return model.labels[model.grid.index(i, j, k)];
  };
  for (int voxel = 0; voxel < 8; ++voxel) {
    at(5 + voxel % 2, 5 + voxel / 2 % 2, 5 + voxel / 4) = 0;
  }
  for (int i = 3; i < 10; ++i) {
    at(i, 12, 12) = 0;
  }
  at(0, 0, 0) = 1;
  at(19, 19, 19) = 2;
  return model;
}

TEST(TidyTest, HolesWithoutAWayOutAreFilledUpToASize) {
  BoneModel model = block();
  EXPECT_EQ(fill_holes(model, 7).voxels, 0U);
  EXPECT_EQ(model.labels, block().labels);
  const TidyResult filled = fill_holes(model, 8);
  EXPECT_EQ(filled.parts, 1U);
  EXPECT_EQ(filled.voxels, 8U);
  EXPECT_EQ(model.labels[model.grid.index(5, 6, 5)], 1);
  EXPECT_EQ(model.labels[model.grid.index(5, 12, 12)], 0) << "the tunnel is open";
  EXPECT_EQ(std::ranges::count(model.labels, 1), 14 * 14 * 14 - 7 + 1);
}

TEST(TidyTest, AHoleInAStructureIsFilledWithItAndTheLowestDensity) {
  BoneModel model = block();
  for (std::uint8_t& label : model.labels) {
    label = label == 1 ? 2 : label;
  }
  for (const std::uint8_t label : model.labels) {
    model.density.push_back(label == 0 ? 0.0F : 0.9F);
  }
  fill_holes(model, 100);
  const std::size_t at = model.grid.index(6, 6, 6);
  EXPECT_EQ(model.labels[at], 2);
  EXPECT_FLOAT_EQ(model.density[at], 0.2F);
  check(model);
}

TEST(TidyTest, OnlyTheLargestPartOfBoneStaysAndStructuresDoToo) {
  BoneModel model = block();
  const TidyResult left = keep_largest_part(model);
  EXPECT_EQ(left.parts, 1U);
  EXPECT_EQ(left.voxels, 1U);
  EXPECT_EQ(model.labels[model.grid.index(0, 0, 0)], 0);
  EXPECT_EQ(model.labels[model.grid.index(19, 19, 19)], 2);
  EXPECT_EQ(std::ranges::count(model.labels, 1), 14 * 14 * 14 - 8 - 7);
}

}  // namespace
}  // namespace haptrial::bone::tidy_test
