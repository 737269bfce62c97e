#include "tests/support/references/surface_samples.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "core/base/random.h"
#include "core/bone/drill/drill.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/solid_bone.h"

namespace haptrial::bone::surface_samples_test {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kSpacing = 1.0 / 2048;
constexpr double kRadius = 2e-3;

TEST(SurfaceSamplesTest, DepthsInAHalfSpaceAreThoseOfGeometry) {
  // A sample at an angle a below the horizon, with z below 0, comes out after z / sin(a). Many
  // samples make the sum an integral over the cap.
  const BoneVolume bone(test::flat_bone(40, kSpacing));
  const std::int32_t count = 4000;
  SurfaceSamples burr(kRadius, count);
  for (const double depth : {0.3e-3, 0.8e-3, 1.5e-3}) {
    const SurfaceContact c =
        burr.touch(bone, Vector3d(1e-4, 2e-4, kRadius - depth), Quaterniond(0.8, 0, 0.6, 0));
    const double h = kRadius - depth;  // of the centre above the bone
    // Share of the sphere below, and the integral of (r - h / u) u over u = sin a from h / r to 1.
    EXPECT_NEAR(c.samples, 0.5 * count * depth / kRadius, 0.02 * count);
    const double u = h / kRadius;
    const double expected = 0.5 * count * (0.5 * kRadius * (1.0 - u * u) - h * (1.0 - u));
    EXPECT_NEAR(c.push.z(), expected, 0.02 * expected);
    EXPECT_LT(c.push.head<2>().norm(), 0.03 * expected);
  }
}

TEST(SurfaceSamplesTest, WholeInBoneTheWaysCancel) {
  const BoneVolume bone(test::solid_bone(40, kSpacing, [](const Vector3d&) { return true; }));
  SurfaceSamples burr(kRadius, 500);
  const SurfaceContact c = burr.touch(bone, Vector3d(1e-4, 0, 0), Quaterniond::Identity());
  EXPECT_EQ(c.samples, 500);
  EXPECT_LT(c.push.norm(), 0.01 * 500 * kRadius);
}

TEST(SurfaceSamplesTest, RemovesAlongItsRaysAndNowhereElse) {
  BoneVolume bone(test::flat_bone(40, kSpacing));
  const BoneVolume before(test::flat_bone(40, kSpacing));
  SurfaceSamples burr(kRadius, 26);
  const Vector3d tip(0, 0, 1e-3);
  burr.touch(bone, tip, Quaterniond::Identity());
  const double taken = burr.remove(bone, 1.0F);
  EXPECT_GT(taken, 0.0);
  EXPECT_EQ(bone.amount() + taken, before.amount());
  for (std::int32_t at = 512; at < bone.bricks() * 512; ++at) {
    if (bone.density(at) != before.density(at)) {
      const Vector3d away =
          bone.grid().centre(bone.voxel_at(at).x(), bone.voxel_at(at).y(), bone.voxel_at(at).z()) -
          tip;
      EXPECT_LT(away.norm(), kRadius + kSpacing);
    }
  }
}

/// Voxels with bone whose centre lies well inside the burr.
int left_under(BoneVolume& bone, const Vector3d& tip) {
  int left = 0;
  for (std::int32_t at = 512; at < bone.bricks() * 512; ++at) {
    const Voxel v = bone.voxel_at(at);
    left +=
        bone.density(at) > 0.0F && (bone.grid().centre(v) - tip).norm() < kRadius - kSpacing / 2.0;
  }
  return left;
}

TEST(SurfaceSamplesTest, LeavesBoneBetweenItsRaysThatTheVolumeTakes) {
  constexpr double kFine = kSpacing / 4.0;
  const Vector3d tip(0, 0, 1e-3);
  const Quaterniond turn(0.8, 0.6, 0, 0);
  BoneVolume by_rays(test::flat_bone(80, kFine));
  BoneVolume by_volume(test::flat_bone(80, kFine));
  SurfaceSamples rays(kRadius, 56);
  // Cells of half a voxel: every voxel holds a sample, at whatever place in its cell that is.
  BurrParameters dense = default_burr(BurrKind::kDiamond, 2 * kRadius);
  dense.sample_spacing = 0.5 * kFine;
  Drill drill(dense, {});
  for (int n = 0; n < 20; ++n) {
    rays.touch(by_rays, tip, turn);
    rays.remove(by_rays, 1.0F);
    drill.begin_tick();
    drill.remove(by_volume, drill.touch(by_volume, tip, turn), 100.0, 1.0, 1.0);
  }
  EXPECT_EQ(left_under(by_volume, tip), 0);
  EXPECT_GT(left_under(by_rays, tip), 100);
}

TEST(SurfaceSamplesTest, ForceIsLimitedInLengthOnly) {
  SurfaceContact contact;
  contact.push = Vector3d(1e-3, 2e-3, -2e-3);
  EXPECT_EQ(surface_force(contact, 100.0, 10.0), 100.0 * contact.push);
  const Vector3d limited = surface_force(contact, 1e6, 10.0);
  EXPECT_NEAR(limited.norm(), 10.0, 1e-12);
  EXPECT_NEAR(limited.normalized().dot(contact.push.normalized()), 1.0, 1e-12);
}

TEST(SurfaceSamplesTest, PlacesThatAreNoneTouchNothing) {
  const BoneVolume bone(test::flat_bone(40, kSpacing));
  SurfaceSamples burr(kRadius, 50);
  const double inf = std::numeric_limits<double>::infinity();
  for (const double bad : {inf, -inf, std::nan(""), 1.0, 1e200}) {
    EXPECT_EQ(burr.touch(bone, Vector3d(0, 0, bad), Quaterniond::Identity()).samples, 0);
  }
  EXPECT_EQ(burr.touch(bone, Vector3d::Zero(), Quaterniond(inf, 0, 0, 0)).samples, 0);
  EXPECT_THROW(SurfaceSamples(0.0, 10), std::invalid_argument);
  EXPECT_THROW(SurfaceSamples(1e-3, 0), std::invalid_argument);
}

TEST(SurfaceSamplesTest, TickDoesNotAllocate) {
  BoneVolume bone(test::flat_bone(40, kSpacing));
  SurfaceSamples burr(kRadius, 56);
  const test::AllocationGuard guard;
  burr.touch(bone, Vector3d(0, 0, 1e-3), Quaterniond::Identity());
  burr.remove(bone, 0.1F);
  EXPECT_EQ(guard.count(), 0U);
}

}  // namespace
}  // namespace haptrial::bone::surface_samples_test
