#include "core/bone/data/bone_summary.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace haptrial::bone::bone_summary_test {
namespace {

using Eigen::Vector3d;

constexpr double kVoxel = 0.5e-3;

/// The surface of what is inside, in a grid of 80 voxels around 0 [m2].
template <class Inside>
double surface_of(const Inside& inside) {
  BoneModel model;
  model.grid = {{80, 80, 80}, Vector3d::Constant(-39.5 * kVoxel), kVoxel};
  model.structures = {{}, {"bone"}};
  for (int k = 0; k < 80; ++k) {
    for (int j = 0; j < 80; ++j) {
      for (int i = 0; i < 80; ++i) {
        model.labels.push_back(inside(model.grid.centre(i, j, k)) ? 1 : 0);
      }
    }
  }
  return summary_of(model).surface;
}

TEST(BoneSummaryTest, TheSurfaceOfABallOrASheetIsItsArea) {
  for (const double radius : {5e-3, 10e-3, 15e-3}) {
    const double area = 4.0 * std::numbers::pi * radius * radius;
    EXPECT_NEAR(surface_of([&](const Vector3d& p) { return p.norm() < radius; }), area,
                0.04 * area);
  }
  const double sheet = 2.0 * 30e-3 * 30e-3 + 4.0 * 30e-3 * kVoxel;  // one voxel thick
  EXPECT_NEAR(surface_of([&](const Vector3d& p) {
                return p.x() > 0.0 && p.x() < kVoxel && std::abs(p.y()) < 15e-3 &&
                       std::abs(p.z()) < 15e-3;
              }),
              sheet, 0.04 * sheet);
}

TEST(BoneSummaryTest, TheSurfaceOfABlockIsItsAreaHoweverItIsTurned) {
  constexpr double kEdge = 20e-3;
  const double area = 6.0 * kEdge * kEdge;
  for (const double angle : {0.0, 0.2, 0.4, std::numbers::pi / 4.0}) {
    const Eigen::Matrix3d turn =
        (Eigen::AngleAxisd(angle, Vector3d::UnitZ()) * Eigen::AngleAxisd(angle, Vector3d::UnitX()))
            .toRotationMatrix();
    EXPECT_NEAR(surface_of([&](const Vector3d& p) {
                  return (turn * p).cwiseAbs().maxCoeff() < 0.5 * kEdge;
                }),
                area, 0.04 * area)
        << angle;
  }
}

}  // namespace
}  // namespace haptrial::bone::bone_summary_test
