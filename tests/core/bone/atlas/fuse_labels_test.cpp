#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <string>

#include "core/base/random.h"
#include "core/bone/atlas/compare_labels.h"
#include "core/bone/atlas/fuse_labels.h"
#include "tests/core/bone/atlas/slabs.h"

namespace haptrial::bone::fuse_labels_test {
namespace {

using test::bone_in_a_row;
using test::slab;
using Ears = std::vector<std::vector<std::uint8_t>>;

TEST(FuseLabelsTest, EarsThatAgreeAreTakenAsTheyAre) {
  BoneModel model = bone_in_a_row(40);
  const Ears ears(3, slab(40, 12, 20));
  const auto carried = fuse_labels(ears, model);
  ASSERT_EQ(carried.size(), 1U);
  EXPECT_EQ(carried[0].label, 2);
  EXPECT_EQ(carried[0].voxels, 8U);
  EXPECT_EQ(carried[0].margin, 0.0);
  for (int i = 0; i < 40; ++i) {
    EXPECT_EQ(model.labels[static_cast<std::size_t>(i)], i >= 12 && i < 20 ? 2 : 1) << i;
  }
}

// Edges at 30, 32 and 34 mm have their mean at 32 mm. Those of the first two have it at 31 mm, and
// the last three voxels of the third ear lie 1, 2 and 3 mm beyond; all 15 others lie inside what
// the rest of the ears give. Of 18 values 95 % are up to the last but one.
TEST(FuseLabelsTest, TheEdgeIsTheMeanAndTheMarginThatOfEarsLeftOut) {
  BoneModel model = bone_in_a_row(60);
  const Ears ears{slab(60, 26, 30), slab(60, 26, 32), slab(60, 26, 34)};
  const auto carried = fuse_labels(ears, model);
  ASSERT_EQ(carried.size(), 1U);
  EXPECT_EQ(carried[0].voxels, 6U);
  ASSERT_TRUE(carried[0].margin);
  EXPECT_NEAR(*carried[0].margin, 2e-3, 1e-9);
}

TEST(FuseLabelsTest, OneEarSaysNothingOfItsError) {
  BoneModel model = bone_in_a_row(40);
  const auto carried = fuse_labels(Ears{slab(40, 12, 20)}, model);
  ASSERT_EQ(carried.size(), 1U);
  EXPECT_FALSE(carried[0].margin);
}

TEST(FuseLabelsTest, TheNearerStructureWinsAndStructuresOfTheBoneStay) {
  BoneModel model = bone_in_a_row(40);
  model.labels[15] = 3;  // drawn by hand
  Ears ears(2, slab(40, 12, 20));
  ears[0][25] = ears[1][25] = 3;
  const auto carried = fuse_labels(ears, model);
  ASSERT_EQ(carried.size(), 2U);
  EXPECT_EQ(model.labels[14], 2);
  EXPECT_EQ(model.labels[15], 3);
  EXPECT_EQ(model.labels[25], 3);
  EXPECT_EQ(carried[0].voxels, 7U);
}

TEST(FuseLabelsTest, DenseBoneStaysBoneUnlessTheStructureIsBone) {
  BoneModel model = bone_in_a_row(40);
  model.density[15] = model.density[25] = 0.5F;
  Ears ears(2, slab(40, 12, 20));
  ears[0][25] = ears[1][25] = 3;
  fuse_labels(ears, model);
  EXPECT_EQ(model.labels[14], 2);
  EXPECT_EQ(model.labels[15], 1);
  EXPECT_EQ(model.density[15], 0.5F);
  EXPECT_EQ(model.labels[25], 3);
}

TEST(FuseLabelsTest, EarsThatDisagreeLeaveNothing) {
  BoneModel model = bone_in_a_row(60);
  const auto carried = fuse_labels(Ears{slab(60, 5, 8), slab(60, 30, 33), slab(60, 50, 53)}, model);
  ASSERT_EQ(carried.size(), 1U);
  EXPECT_EQ(carried[0].voxels, 0U);
  EXPECT_FALSE(carried[0].margin);
}

// A true structure of 20 mm and those of five ears are displaced alike, with 3 mm of standard
// deviation: how often the margin that ears without the truth state holds its voxels.
TEST(FuseLabelsTest, TheMarginHoldsWhatItSays) {
  RandomStream random(7, "margin");
  double held = 0.0;
  constexpr int kTimes = 300;
  for (int time = 0; time < kTimes; ++time) {
    const auto displaced = [&] {
      const int from = 40 + static_cast<int>(std::lround(3.0 * random.normal()));
      return slab(100, from, from + 20);
    };
    BoneModel truth = bone_in_a_row(100);
    truth.labels = displaced();
    Ears ears;
    for (int ear = 0; ear < 5; ++ear) {
      ears.push_back(displaced());
    }
    BoneModel model = bone_in_a_row(100);
    const auto carried = fuse_labels(ears, model);
    held += *compare_label(model, 2, truth, carried.at(0).margin)->held / kTimes;
  }
  RecordProperty("held", std::to_string(held));
  EXPECT_GT(held, 0.94);
  EXPECT_LT(held, 0.99);
}

}  // namespace
}  // namespace haptrial::bone::fuse_labels_test

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
