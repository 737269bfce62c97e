#include "core/bone/atlas/compare_labels.h"

#include <gtest/gtest.h>

#include "tests/core/bone/atlas/slabs.h"

namespace haptrial::bone::compare_labels_test {
namespace {

using test::bone_in_a_row;
using test::slab;

BoneModel row(int from, int to) {
  BoneModel model = bone_in_a_row(60);
  model.labels = slab(60, from, to);
  return model;
}

// In a row of voxels every one is of the surface. Slabs of 10, 4 mm apart, share 6: of either the
// four beyond the other lie 1 to 4 mm away, which is 20 mm over 20 voxels.
TEST(CompareLabelsTest, ADisplacedSlabHasTheNumbersOfItsDisplacement) {
  const auto match = compare_label(row(20, 30), 2, row(24, 34), 3e-3);
  ASSERT_TRUE(match);
  EXPECT_DOUBLE_EQ(match->dice, 0.6);
  ASSERT_TRUE(match->distance);
  EXPECT_NEAR(*match->distance, 1e-3, 1e-9);
  EXPECT_DOUBLE_EQ(*match->held, 0.9);
}

TEST(CompareLabelsTest, TheTruthMayHaveFinerVoxelsAndOtherLabels) {
  BoneModel truth = bone_in_a_row(1);
  truth.grid = {{240, 1, 1}, Eigen::Vector3d(-0.375e-3, 0.0, 0.0), 0.25e-3};
  truth.structures[2].name = "incus";
  truth.structures[3].name = "facial nerve";
  truth.labels = slab(240, 80, 120, 3);
  const auto match = compare_label(row(20, 30), 2, truth, std::nullopt);
  ASSERT_TRUE(match);
  EXPECT_DOUBLE_EQ(match->dice, 1.0);
  EXPECT_FALSE(match->held);
}

TEST(CompareLabelsTest, WhatTheTruthLacksIsNotCompared) {
  BoneModel truth = row(20, 30);
  truth.structures[2].name = "stapes";
  EXPECT_FALSE(compare_label(row(20, 30), 2, truth, std::nullopt));
}

TEST(CompareLabelsTest, WhatIsLostHasNoDistance) {
  const auto match = compare_label(row(20, 20), 2, row(20, 30), 1e-3);
  ASSERT_TRUE(match);
  EXPECT_EQ(match->dice, 0.0);
  EXPECT_FALSE(match->distance);
  EXPECT_EQ(match->held, 0.0);
}

}  // namespace
}  // namespace haptrial::bone::compare_labels_test
