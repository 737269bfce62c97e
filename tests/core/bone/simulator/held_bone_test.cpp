// Bone that a hand carries among other bone: it stays out, is guided, and rubs.

#include "core/bone/simulator/held_bone.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/core/bone/model/pieces_support.h"
#include "tests/support/allocation_guard.h"

namespace haptrial::bone::held_bone_test {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kDt = 1e-3;
constexpr int kGap = 4;  // voxels between both blocks

/// A large block below, and above it a smaller one: 20 x 20 x 12 voxels of 0.5 mm.
BoneModel two_blocks() {
  return test::make_bone({48, 48, 40}, [](const Voxel& v) {
    const bool above = v.z() >= 20 + kGap && v.z() < 32 + kGap && v.x() >= 14 && v.x() < 34 &&
                       v.y() >= 14 && v.y() < 34;
    return v.z() < 20 || above;
  });
}

WorldParameters splitting() {
  WorldParameters parameters;
  parameters.split_initial = true;
  return parameters;
}

class HeldBoneTest : public ::testing::Test {
 protected:
  HeldBoneTest() : world_(two_blocks(), Isometry3d::Identity(), splitting()) {
    test::settle(world_);
    grip_.translation() = world_.volume(0).grid().centre(24, 24, 31 + kGap);
    world_.grab({1, Voxel(24, 24, 31 + kGap), 0.0}, grip_);
    held_.begin(grip_);
    for (int tick = 0; tick < 200; ++tick) {  // until the samples are found
      hold(grip_);
    }
  }

  HeldBone::HeldStep hold(const Isometry3d& hand) {
    const HeldBone::HeldStep followed = held_.follow(world_, hand, kDt);
    world_.drag(followed.tool);
    return followed;
  }
  /// Leads the hand to a shift from its first place, in a straight line. @returns the last tick
  HeldBone::HeldStep lead(const Vector3d& from, const Vector3d& to, int ticks) {
    HeldBone::HeldStep last;
    for (int tick = 1; tick <= ticks; ++tick) {
      Isometry3d hand = grip_;
      hand.translation() += from + (to - from) * tick / ticks;
      last = hold(hand);
    }
    return last;
  }
  double height() const { return world_.pose(1).translation().z(); }

  BoneWorld world_;
  HeldBone held_;
  Isometry3d grip_{Isometry3d::Identity()};
};

TEST_F(HeldBoneTest, GoesWithTheHandExactlyWhileItTouchesNothing) {
  Isometry3d hand = grip_;
  for (int tick = 0; tick < 300; ++tick) {
    hand.translation() += Vector3d(2e-5, -1e-5, 1e-5);
    hand.rotate(Eigen::AngleAxisd(1e-3, Vector3d::UnitX()));
    const HeldBone::HeldStep followed = hold(hand);
    EXPECT_TRUE(followed.force.isZero(0.0));
    EXPECT_EQ(followed.tool.matrix(), hand.matrix());
  }
}

TEST_F(HeldBoneTest, RestsOnTheOtherBoneAndTheHandFeelsItsSpring) {
  constexpr double kDown = 6e-3;  // the gap is 2 mm
  lead(Vector3d::Zero(), {0.0, 0.0, -kDown}, 1000);
  const HeldBone::HeldStep at = lead({0.0, 0.0, -kDown}, {0.0, 0.0, -kDown}, 200);
  // Samples are centres of voxels: surfaces overlap by half of one when these touch.
  EXPECT_NEAR(height(), -(kGap + 0.5) * 0.5e-3, 0.1e-3);
  EXPECT_GT(at.touching, 20);
  EXPECT_NEAR(at.force.z(), HeldBone::kHandStiffness * (kDown + height()), 0.02);
  EXPECT_LT(at.force.head<2>().norm(), 0.02);
}

TEST_F(HeldBoneTest, ATiltedFragmentIsGuidedFlat) {
  constexpr double kTilt = 0.05;
  Isometry3d hand = grip_;
  hand.rotate(Eigen::AngleAxisd(kTilt, Vector3d::UnitX()));
  for (int tick = 0; tick < 1500; ++tick) {
    hand.translation().z() = grip_.translation().z() - 5e-6 * std::min(tick, 1300);
    hold(hand);
  }
  const double angle = Eigen::AngleAxisd(world_.pose(1).linear()).angle();
  EXPECT_LT(angle, 0.3 * kTilt);  // the hand still turns it a little
}

TEST_F(HeldBoneTest, SticksBelowTheAngleOfFrictionAndSlidesAbove) {
  const double normal = 4e-3;  // of the hand below the surface [m]
  const Vector3d down(0.0, 0.0, -2.25e-3 - normal);
  lead(Vector3d::Zero(), down, 800);
  lead(down, down, 300);
  const double before = world_.pose(1).translation().x();
  const Vector3d below = down + 0.5 * HeldBone::kFriction * normal * Vector3d::UnitX();
  lead(down, below, 200);
  lead(below, below, 300);
  const double stuck = world_.pose(1).translation().x() - before;
  EXPECT_LT(stuck, 0.1e-3);
  const Vector3d above = down + 3.0 * HeldBone::kFriction * normal * Vector3d::UnitX();
  lead(below, above, 400);
  const HeldBone::HeldStep at = lead(above, above, 3000);
  EXPECT_GT(world_.pose(1).translation().x() - before, 1e-3);
  // What is left of the pull is what friction bears, and edges that catch on voxels.
  EXPECT_LT(-at.force.x(), 1.5 * HeldBone::kFriction * at.force.z());
}

TEST_F(HeldBoneTest, AClosedPathCostsTheHandEnergyAndNeverGivesAny) {
  const Vector3d down(0.0, 0.0, -4e-3);
  lead(Vector3d::Zero(), down, 500);
  double given = 0.0;  // by the bone to the hand [J]
  Isometry3d hand = grip_;
  hand.translation() += down;
  for (int n = 0; n < 6000; ++n) {
    const double angle = 2.0 * std::numbers::pi * n / 3000;
    const Vector3d to = grip_.translation() + down +
                        Vector3d(3e-3 * std::sin(angle), 2e-3 * std::sin(2.0 * angle),
                                 1.5e-3 * (1.0 - std::cos(angle)));
    const Vector3d step = to - hand.translation();
    hand.translation() = to;
    given += hold(hand).force.dot(step);
  }
  EXPECT_LT(given, 0.0);
}

TEST_F(HeldBoneTest, ATickDoesNotAllocate) {
  test::AllocationGuard guard;
  lead(Vector3d::Zero(), {1e-3, 0.0, -6e-3}, 400);
  EXPECT_EQ(guard.count(), 0U);
}

}  // namespace
}  // namespace haptrial::bone::held_bone_test
