#include "core/bone/data/resample.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "core/bone/data/grey_bone.h"

namespace haptrial::bone {
namespace {

/// A volume of grey values value(place) [m].
template <class Value>
UprightVolume volume_of(std::array<std::int32_t, 3> size, const Eigen::Matrix3d& steps,
                        Value&& value) {
  UprightVolume volume;
  volume.size = size;
  volume.steps = steps;
  volume.origin = Eigen::Vector3d(0.01, -0.02, 0.03);
  BigArray<float>& values = volume.components.emplace_back();
  for (int k = 0; k < size[2]; ++k) {
    for (int j = 0; j < size[1]; ++j) {
      for (int i = 0; i < size[0]; ++i) {
        const Eigen::Vector3d place = volume.origin + steps * Eigen::Vector3d(i, j, k);
        values.push_back(static_cast<float>(value(place)));
      }
    }
  }
  return volume;
}

Eigen::Matrix3d edges(double x, double y, double z) {
  return Eigen::Vector3d(x, y, z).asDiagonal();
}

/// The largest difference from value(place), away from the borders.
template <class Value>
double worst_error(const geometry::VoxelGrid& grid, const BigArray<float>& values, int border,
                   Value&& value) {
  double worst = 0.0;
  for (int k = border; k < grid.size[2] - border; ++k) {
    for (int j = border; j < grid.size[1] - border; ++j) {
      for (int i = border; i < grid.size[0] - border; ++i) {
        const double exact = value(grid.centre(i, j, k));
        worst = std::max(worst, std::abs(values[grid.index(i, j, k)] - exact));
      }
    }
  }
  return worst;
}

TEST(ResampleTest, ASlowWaveComesOutFinerAsItIs) {
  // More than six voxels to a wave along every axis.
  const auto wave = [](const Eigen::Vector3d& p) {
    return std::sin(2.0 * std::numbers::pi * (p.x() / 6.7e-3 + p.y() / 7.9e-3 + p.z() / 14.3e-3));
  };
  const UprightVolume volume = volume_of({30, 30, 20}, edges(1e-3, 1e-3, 2e-3), wave);
  const geometry::VoxelGrid grid = grid_over(volume, 0.5e-3, true);
  EXPECT_EQ(grid.size, (std::array<std::int32_t, 3>{59, 59, 77}));
  EXPECT_LT(worst_error(grid, resample_grey(volume, grid, true, {}), 14, wave), 0.04);
}

TEST(ResampleTest, TurnedAxesGiveTheSameWave) {
  const auto wave = [](const Eigen::Vector3d& p) {
    return std::sin(2.0 * std::numbers::pi * (p.x() + 0.5 * p.y() - 0.7 * p.z()) / 8e-3);
  };
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.5, Eigen::Vector3d(1, -1, 2).normalized()).toRotationMatrix();
  const UprightVolume volume = volume_of({28, 28, 28}, turn * edges(1e-3, 1e-3, 1e-3), wave);
  EXPECT_NEAR(pose_of(volume).turn, 0.5, 1e-12);
  const geometry::VoxelGrid grid = grid_over(volume, 1e-3, false);
  EXPECT_LT(worst_error(grid, resample_grey(volume, grid, false, {}), 16, wave), 0.04);
}

TEST(ResampleTest, WhatCoarseVoxelsCannotHoldIsGone) {
  // 2.5 voxels to a wave; voxels four times as large would show a false one of 5/3 of theirs.
  const auto wave = [](const Eigen::Vector3d& p) {
    return std::sin(2.0 * std::numbers::pi * p.x() / 2.5e-3);
  };
  const UprightVolume volume = volume_of({120, 8, 8}, edges(1e-3, 1e-3, 1e-3), wave);
  const geometry::VoxelGrid grid = grid_over(volume, 4e-3, true);
  const auto values = resample_grey(volume, grid, true, {});
  double largest = 0.0;
  for (int i = 4; i < grid.size[0] - 4; ++i) {
    largest = std::max(largest, static_cast<double>(std::abs(values[grid.index(i, 0, 0)])));
  }
  EXPECT_LT(largest, 0.02);
}

TEST(ResampleTest, AConstantStaysOneUpToTheBorder) {
  const auto same = [](const Eigen::Vector3d&) { return 7.0; };
  const UprightVolume volume = volume_of({5, 6, 7}, edges(1e-3, 2e-3, 3e-3), same);
  for (const double spacing : {0.3e-3, 1e-3, 5e-3}) {
    const geometry::VoxelGrid grid = grid_over(volume, spacing, true);
    EXPECT_LT(worst_error(grid, resample_grey(volume, grid, true, {}), 0, same), 1e-5);
  }
}

TEST(ResampleTest, CoarserVoxelsTakeTheLabelOfMost) {
  const auto none = [](const Eigen::Vector3d&) { return 0.0; };
  const UprightVolume volume = volume_of({4, 2, 2}, edges(1e-3, 1e-3, 1e-3), none);
  std::vector<std::uint8_t> labels(16, 0);
  const auto set = [&](std::size_t i, std::size_t j, std::size_t k, std::uint8_t label) {
    labels[i + 4 * (j + 2 * k)] = label;
  };
  // Five of eight voxels to the left hold something, three of them 2; to the right three of eight.
  set(0, 0, 0, 2), set(1, 0, 0, 2), set(0, 1, 0, 2), set(0, 0, 1, 5), set(1, 1, 1, 5);
  set(2, 0, 0, 2), set(3, 0, 0, 2), set(2, 1, 0, 2);
  const geometry::VoxelGrid grid{
      {2, 1, 1}, volume.origin + Eigen::Vector3d::Constant(0.5e-3), 2e-3};
  EXPECT_EQ(resample_labels(labels, volume, grid, true, {}), (std::vector<std::uint8_t>{2, 0}));
}

TEST(ResampleTest, FinerVoxelsTakeTheNearestLabel) {
  const auto none = [](const Eigen::Vector3d&) { return 0.0; };
  const UprightVolume volume = volume_of({3, 1, 1}, edges(3e-3, 3e-3, 3e-3), none);
  const std::vector<std::uint8_t> labels{4, 0, 9};
  const geometry::VoxelGrid grid = grid_over(volume, 1e-3, true);
  EXPECT_EQ(resample_labels(labels, volume, grid, true, {}),
            (std::vector<std::uint8_t>{4, 4, 0, 0, 0, 9, 9}));
}

TEST(ResampleTest, DensityIsTheShareOfDenseBoneInHounsfieldUnits) {
  const GreyLevels levels{300.0, 1500.0};
  EXPECT_EQ(density_of(299.9, levels), 0.0F);
  for (const double value : {300.0, 700.0, 1500.0}) {
    EXPECT_NEAR(density_of(value, levels), value / 1500.0, 0.5 / 255.0);
  }
  EXPECT_EQ(density_of(3000.0, levels), 1.0F);
}

TEST(ResampleTest, TheThresholdLiesBetweenTheUpperTwoOfThreeClasses) {
  std::vector<float> values;
  for (int i = 0; i < 3000; ++i) {
    const int jitter = i % 100;
    values.push_back(static_cast<float>(i < 1500   ? jitter
                                        : i < 2600 ? 900 + jitter
                                                   : 2500 + jitter));
  }
  EXPECT_GT(find_threshold(values), 999.0);
  EXPECT_LT(find_threshold(values), 2501.0);
}

}  // namespace
}  // namespace haptrial::bone
