#include "core/bone/model/thickness.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <numbers>

#include "tests/support/allocation_guard.h"

namespace haptrial::bone {
namespace {

constexpr double kEdge = 0.5e-3;  // of a voxel [m]
constexpr int kSize = 48;

template <class F>
BoneVolume volume_of(F&& label_at) {
  BoneModel model;
  model.grid = {
      {kSize, kSize, kSize}, Eigen::Vector3d::Constant(-0.5 * kEdge * (kSize - 1)), kEdge};
  model.structures.resize(3);
  model.labels.resize(model.grid.count());
  for (int k = 0; k < kSize; ++k) {
    for (int j = 0; j < kSize; ++j) {
      for (int i = 0; i < kSize; ++i) {
        model.labels[model.grid.index(i, j, k)] = label_at(model.grid.centre(i, j, k));
      }
    }
  }
  return BoneVolume(model);
}

/// Voxels whose centres lie within half the thickness of a plane through the middle.
BoneVolume slab(const Eigen::Vector3d& normal, double thickness) {
  return volume_of([&](const Eigen::Vector3d& p) -> std::uint8_t {
    return std::abs(normal.dot(p)) < 0.5 * thickness ? 1 : 0;
  });
}

TEST(ThicknessTest, SlabsAtAnyAngleAreAsThickAsTheyWereMadeWithinAVoxel) {
  int measured = 0;
  for (const double thickness : {3.3 * kEdge, 5.0 * kEdge, 9.7 * kEdge}) {
    for (const double turn : {0.0, 0.2, 0.5, std::numbers::pi / 4, 1.1}) {
      for (const double tilt : {0.0, 0.3, 0.7}) {
        const Eigen::Vector3d normal(std::cos(turn) * std::cos(tilt),
                                     std::sin(turn) * std::cos(tilt), std::sin(tilt));
        const BoneVolume volume = slab(normal, thickness);
        std::vector<Voxel> voxels;
        surface_voxels_within(volume, Eigen::Vector3d::Zero(), 5e-3, voxels);
        ASSERT_GT(voxels.size(), 50U);
        for (const Voxel& voxel : voxels) {
          const auto found = thickness_at(volume, voxel);
          ASSERT_TRUE(found) << voxel.transpose();
          EXPECT_NEAR(*found, thickness, std::sqrt(2.0) * kEdge) << turn << ' ' << tilt;
          const auto out = outward_normal(volume, voxel);
          ASSERT_TRUE(out);
          EXPECT_GT(std::abs(out->dot(normal)), 0.94);
          ++measured;
        }
        const auto mean = mean_thickness(volume, voxels, {}, 1000);
        ASSERT_TRUE(mean);
        EXPECT_NEAR(*mean, thickness, kEdge) << turn << ' ' << tilt;
      }
    }
  }
  EXPECT_GT(measured, 10'000);
}

TEST(ThicknessTest, AlongAnAxisItIsExact) {
  const BoneVolume volume = slab(Eigen::Vector3d::UnitZ(), 6.0 * kEdge);
  std::vector<Voxel> voxels;
  surface_voxels_within(volume, Eigen::Vector3d(0, 0, 3.0 * kEdge), 2e-3, voxels);
  for (const Voxel& voxel : voxels) {
    EXPECT_NEAR(*thickness_at(volume, voxel), 6.0 * kEdge, 1e-12);
  }
}

TEST(ThicknessTest, ThickBoneCountsAsTheLimitAndDrillingThinsIt) {
  BoneVolume volume = slab(Eigen::Vector3d::UnitZ(), 20.0 * kEdge);
  const Voxel top(24, 24, 33);
  ThicknessParameters parameters;
  parameters.limit = 3e-3;
  ASSERT_GT(volume.density(top), 0.0F);
  EXPECT_DOUBLE_EQ(*thickness_at(volume, top, parameters), 3e-3);
  // A hole from below, of four voxels' radius, reaches up to four voxels under the top.
  for (int k = 14; k < 30; ++k) {
    for (int j = 16; j <= 32; ++j) {
      for (int i = 16; i <= 32; ++i) {
        volume.take(volume.address(Voxel(i, j, k)), 1.0F);
      }
    }
  }
  EXPECT_NEAR(*thickness_at(volume, top, parameters), 4.0 * kEdge, 1e-12);
}

TEST(ThicknessTest, EndsAtWhatIsNotBone) {
  const BoneVolume volume = volume_of([](const Eigen::Vector3d& p) -> std::uint8_t {
    return p.z() > 5e-3 ? 0 : p.z() > 3e-3 ? 1 : 2;
  });
  ThicknessParameters parameters;
  parameters.bone.reset(2);
  std::vector<Voxel> voxels;
  surface_voxels_within(volume, Eigen::Vector3d(0, 0, 5e-3), 1e-3, voxels);
  ASSERT_FALSE(voxels.empty());
  EXPECT_NEAR(*mean_thickness(volume, voxels, parameters), 2e-3, 0.5 * kEdge);
  EXPECT_DOUBLE_EQ(*mean_thickness(volume, voxels), 10e-3);  // all labels: as thick as the limit
}

TEST(ThicknessTest, WhereThereIsNoBoneOrNoSideThereIsNone) {
  const BoneVolume volume = slab(Eigen::Vector3d::UnitX(), 10e-3);
  EXPECT_FALSE(thickness_at(volume, Voxel(0, 24, 24)));
  EXPECT_FALSE(thickness_at(volume, Voxel(-5, 24, 900)));
  EXPECT_FALSE(thickness_at(volume, Voxel(24, 24, 24)));  // inside: no gradient
  EXPECT_FALSE(mean_thickness(volume, {}));
  EXPECT_THROW(thickness_at(volume, Voxel(24, 24, 24), {.reach = 9}), std::invalid_argument);
}

TEST(ThicknessTest, DoesNotAllocate) {
  const BoneVolume volume = slab(Eigen::Vector3d::UnitZ(), 6.0 * kEdge);
  std::vector<Voxel> voxels;
  surface_voxels_within(volume, Eigen::Vector3d(0, 0, 3.0 * kEdge), 3e-3, voxels);
  const test::AllocationGuard guard;
  const auto mean = mean_thickness(volume, voxels);
  EXPECT_EQ(guard.count(), 0U);
  EXPECT_TRUE(mean);
}

}  // namespace
}  // namespace haptrial::bone
