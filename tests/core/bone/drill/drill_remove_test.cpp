#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <stdexcept>

#include "core/bone/drill/drill.h"
#include "tests/support/solid_bone.h"

namespace haptrial::bone::drill_remove_test {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kSpacing = 1.0 / 2048;
constexpr double kVoxel = kSpacing * kSpacing * kSpacing;
const Quaterniond kUpright = Quaterniond::Identity();
const Quaterniond kLying(Eigen::AngleAxisd(0.5 * std::numbers::pi, Vector3d::UnitY()));

/// Bone that one tick takes from fresh flat bone, the burr `depth` deep.
double removed(const BurrParameters& burr, double depth, const Quaterniond& turn, double force,
               double power, double dt) {
  BoneVolume bone(test::flat_bone(40, kSpacing));
  Drill drill(burr, {});
  const Vector3d tip(1e-4, 2e-4, 0.5 * burr.diameter - depth);
  return drill.remove(bone, drill.touch(bone, tip, turn), force, power, dt).amount;
}

TEST(DrillRemoveTest, GrowsWithForceTimeAndPower) {
  const BurrParameters burr = default_burr(BurrKind::kCutting, 4e-3);
  const double one = removed(burr, 0.5e-3, kLying, 1.0, 1.0, 1e-2);
  ASSERT_GT(one, 0.0);
  // Amounts of a sample are rounded to 2^-23.
  const double tolerance = 2e-4 * one;
  EXPECT_NEAR(removed(burr, 0.5e-3, kLying, 2.0, 1.0, 1e-2), 2.0 * one, tolerance);
  EXPECT_NEAR(removed(burr, 0.5e-3, kLying, 1.0, 1.0, 3e-2), 3.0 * one, tolerance);
  EXPECT_NEAR(removed(burr, 0.5e-3, kLying, 1.0, 0.5, 1e-2), 0.5 * one, tolerance);
}

TEST(DrillRemoveTest, IsTheImmersedVolumeTimesForceAndRate) {
  BurrParameters burr = default_burr(BurrKind::kDiamond, 4e-3);
  burr.falloff = 0.0;  // every sample takes as much
  burr.removal_rate = 8.0;
  const double depth = 0.7e-3;
  const double cap = std::numbers::pi * depth * depth * (2e-3 - depth / 3.0);
  EXPECT_NEAR(kVoxel * removed(burr, depth, kUpright, 1.5, 1.0, 1e-2), cap * 1.5 * 8.0 * 1e-2,
              0.02 * cap * 1.5 * 8.0 * 1e-2);
}

TEST(DrillRemoveTest, HardlyDependsOnTheSampling) {
  BurrParameters burr = default_burr(BurrKind::kCutting, 4e-3);
  const double fine = removed(burr, 0.8e-3, kLying, 1.0, 1.0, 1e-2);
  burr.sample_spacing *= 2.0;
  EXPECT_NEAR(removed(burr, 0.8e-3, kLying, 1.0, 1.0, 1e-2), fine, 0.05 * fine);
}

TEST(DrillRemoveTest, FallsTowardsThePoleAndDiffersByKind) {
  const auto ratio = [](BurrKind kind) {
    const BurrParameters burr = default_burr(kind, 4e-3);
    return removed(burr, 0.5e-3, kUpright, 1.0, 1.0, 1e-2) /
           removed(burr, 0.5e-3, kLying, 1.0, 1.0, 1e-2);
  };
  EXPECT_LT(ratio(BurrKind::kDiamond), 0.9);
  EXPECT_LT(ratio(BurrKind::kCutting), 0.7 * ratio(BurrKind::kDiamond));
  EXPECT_GT(removed(default_burr(BurrKind::kCutting, 4e-3), 0.5e-3, kLying, 1.0, 1.0, 1e-2),
            1.5 * removed(default_burr(BurrKind::kDiamond, 4e-3), 0.5e-3, kLying, 1.0, 1.0, 1e-2));
  // Without falloff pole and equator are the same but for the sampling.
  BurrParameters even = default_burr(BurrKind::kCutting, 4e-3);
  even.falloff = 0.0;
  EXPECT_NEAR(removed(even, 0.5e-3, kUpright, 1.0, 1.0, 1e-2),
              removed(even, 0.5e-3, kLying, 1.0, 1.0, 1e-2),
              0.03 * removed(even, 0.5e-3, kLying, 1.0, 1.0, 1e-2));
}

TEST(DrillRemoveTest, HardStructuresLastLonger) {
  BoneModel model = test::flat_bone(40, kSpacing);
  for (std::size_t n = 0; n < model.labels.size(); ++n) {
    model.labels[n] = static_cast<std::uint8_t>(model.labels[n] * (1 + n % 2));  // stripes
  }
  model.structures.push_back({"enamel", {1, 1, 1}, 4.0, false});
  BoneVolume bone(model);
  Drill drill(default_burr(BurrKind::kCutting, 6e-3), model.structures);
  drill.remove(bone, drill.touch(bone, Vector3d(0, 0, 1e-3), kLying), 1.0, 1.0, 1e-2);
  double taken[3] = {};
  for (std::int32_t at = BoneVolume::kBrickVoxels; at < bone.bricks() * 512; ++at) {
    if (bone.label(at) != 0) {
      taken[bone.label(at)] += 1.0 - static_cast<double>(bone.density(at));
    }
  }
  EXPECT_GT(taken[2], 0.0);
  EXPECT_NEAR(taken[1] / taken[2], 4.0, 0.1);
}

TEST(DrillRemoveTest, AHardnessMustBeAboveZero) {
  const std::vector<Structure> structures{{}, {"air", {1, 1, 1}, 0.0, false}};
  EXPECT_THROW(Drill(BurrParameters{}, structures), std::invalid_argument);
}

TEST(DrillRemoveTest, WhatIsTakenIsWhatIsGoneToTheLastBit) {
  BoneVolume bone(test::flat_bone(40, kSpacing));
  Drill drill(default_burr(BurrKind::kCutting, 5e-3), {});
  const double start = bone.amount();
  double taken = 0.0;
  for (int n = 0; n < 200; ++n) {
    drill.begin_tick();
    const Contact c = drill.touch(bone, Vector3d(2e-5 * n, 0, 1e-3), kLying);
    const Removal removal = drill.remove(bone, c, 3.0, 1.0, 3e-3);
    EXPECT_EQ(removal.volume, removal.amount * kVoxel);
    taken += removal.amount;
  }
  EXPECT_GT(taken, 100.0);
  EXPECT_EQ(bone.amount() + taken, start);
}

TEST(DrillRemoveTest, EveryEmptiedVoxelIsReportedOnce) {
  BoneVolume bone(test::flat_bone(40, kSpacing));
  const BoneVolume before(test::flat_bone(40, kSpacing));
  Drill drill(default_burr(BurrKind::kCutting, 5e-3), {});
  std::set<std::int32_t> emptied;
  for (int n = 0; n < 300; ++n) {
    drill.begin_tick();
    const Contact c = drill.touch(bone, Vector3d(1e-5 * n, 0, 1e-3), kLying);
    for (const EmptiedVoxel& voxel : drill.remove(bone, c, 5.0, 1.0, 5e-3).emptied) {
      EXPECT_TRUE(emptied.insert(voxel.address).second);
      EXPECT_EQ(voxel.label, 1);
    }
  }
  std::set<std::int32_t> gone;
  for (std::int32_t at = 0; at < bone.bricks() * 512; ++at) {
    if (before.density(at) > 0.0F && !(bone.density(at) > 0.0F)) {
      gone.insert(at);
    }
  }
  EXPECT_GT(gone.size(), 100U);
  EXPECT_EQ(emptied, gone);
}

TEST(DrillRemoveTest, SeveralBonesInOneTickLoseEachItsOwn) {
  BoneVolume left(
      test::solid_bone(40, kSpacing, [](const Vector3d& p) { return p.z() < 0.0 && p.x() < 0.0; }));
  BoneVolume right(
      test::solid_bone(40, kSpacing, [](const Vector3d& p) { return p.z() < 0.0 && p.x() > 0.0; }));
  BoneVolume whole(test::flat_bone(40, kSpacing));
  Drill drill(default_burr(BurrKind::kCutting, 4e-3), {});
  const Vector3d tip(0, 1e-4, 1e-3);
  const Contact a = drill.touch(left, tip, kLying);
  const Contact b = drill.touch(right, tip, kLying);
  const double sum =
      drill.remove(left, a, 1.0, 1.0, 1e-2).amount + drill.remove(right, b, 1.0, 1.0, 1e-2).amount;
  drill.begin_tick();
  EXPECT_EQ(drill.remove(whole, drill.touch(whole, tip, kLying), 1.0, 1.0, 1e-2).amount, sum);
  EXPECT_EQ(left.amount() + right.amount(), whole.amount());
}

TEST(DrillRemoveTest, WhatDoesNotFitTheListIsFeltButStays) {
  BoneVolume bone(test::solid_bone(40, kSpacing, [](const Vector3d&) { return true; }));
  Drill drill(default_burr(BurrKind::kDiamond, 4e-3), {});
  Contact last;
  for (int n = 0; n <= Drill::kBonesAtOnce; ++n) {
    last = drill.touch(bone, Vector3d::Zero(), kUpright);
    EXPECT_EQ(last.samples, drill.burr().samples());
  }
  EXPECT_EQ(last.kept, 0);
  EXPECT_EQ(drill.remove(bone, last, 1.0, 1.0, 1.0).amount, 0.0);
}

TEST(DrillRemoveTest, AContactOfAForgottenTickRemovesNothing) {
  BoneVolume bone(test::flat_bone(40, kSpacing));
  Drill drill(default_burr(BurrKind::kCutting, 4e-3), {});
  const Contact c = drill.touch(bone, Vector3d(0, 0, 1e-3), kLying);
  ASSERT_TRUE(c);
  drill.begin_tick();
  EXPECT_EQ(drill.remove(bone, c, 1.0, 1.0, 1e-2).amount, 0.0);
}

TEST(DrillRemoveTest, NothingIsTakenWithoutForcePowerOrTime) {
  BoneVolume bone(test::flat_bone(40, kSpacing));
  Drill drill(default_burr(BurrKind::kCutting, 4e-3), {});
  const Contact c = drill.touch(bone, Vector3d(0, 0, 1e-3), kLying);
  const double inf = std::numeric_limits<double>::infinity();
  for (const double bad : {0.0, -1.0, std::nan(""), inf}) {
    EXPECT_EQ(drill.remove(bone, c, bad, 1.0, 1e-3).amount, 0.0);
    EXPECT_EQ(drill.remove(bone, c, 1.0, bad, 1e-3).amount, 0.0);
    EXPECT_EQ(drill.remove(bone, c, 1.0, 1.0, bad).amount, 0.0);
  }
  EXPECT_EQ(bone.amount(), 20.0 * 40 * 40);
  // The largest step takes all that the burr reaches with power above 0, and no more.
  const Removal all = drill.remove(bone, c, 1e30, 1.0, 1.0);
  EXPECT_EQ(all.amount, static_cast<double>(all.emptied.size()));
}

}  // namespace
}  // namespace haptrial::bone::drill_remove_test
