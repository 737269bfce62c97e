#include "core/render/bone/bone_camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace haptrial::render {
namespace {

/// Place of a point of W in the picture, from -1 to 1 each way.
Eigen::Vector3d clip(const EyeView& view, const Eigen::Vector3d& point) {
  const Eigen::Vector4d p = view.projection * view.view * point.homogeneous();
  return p.hnormalized();
}

const Camera kCamera{{0.3, 0.1, 0.2}, {0.02, 0.01, -0.03}, {0.0, 0.0, 2.0}, 0.4};

TEST(BoneCameraTest, TheTargetIsInTheMiddleAndTheFieldOfViewReachesTheEdge) {
  const EyeView view = view_of(kCamera, 1.5);
  EXPECT_NEAR(clip(view, kCamera.target).head<2>().norm(), 0.0, 1e-12);
  const Eigen::Matrix3d axes = kCamera.pose().linear();
  EXPECT_NEAR((axes * axes.transpose() - Eigen::Matrix3d::Identity()).norm(), 0.0, 1e-12);
  EXPECT_GT(axes.col(1).z(), 0.0) << "up is up";
  const double half = kCamera.distance() * std::tan(0.2);
  EXPECT_NEAR(clip(view, kCamera.target + half * axes.col(1)).y(), 1.0, 1e-9);
  EXPECT_NEAR(clip(view, kCamera.target + 1.5 * half * axes.col(0)).x(), 1.0, 1e-9);
  EXPECT_LT(clip(view, kCamera.target + 0.1 * axes.col(2)).z(), clip(view, kCamera.target).z())
      << "nearer has less depth";
}

TEST(BoneCameraTest, TheWholeBoxFitsAndTouchesAnEdge) {
  const Eigen::AlignedBox3d box(Eigen::Vector3d(-0.02, 0.01, 0.0),
                                Eigen::Vector3d(0.03, 0.05, 0.09));
  for (const double aspect : {0.5, 1.0, 1.8}) {
    for (const Eigen::Vector3d& from :
         {Eigen::Vector3d(-1, 0.2, 0.1), Eigen::Vector3d(0.3, 2, -1)}) {
      const EyeView view = view_of(looking_at(box, from, Eigen::Vector3d::UnitZ(), aspect), aspect);
      double farthest = 0.0;
      for (int c = 0; c < 8; ++c) {
        const Eigen::Vector3d p =
            clip(view, box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(c)));
        farthest = std::max(farthest, p.head<2>().cwiseAbs().maxCoeff());
        EXPECT_LT(std::abs(p.z()), 1.0);
      }
      EXPECT_NEAR(farthest, 1.0 / 1.05, 1e-9);
    }
  }
  EXPECT_THROW(looking_at({}, Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitZ(), 1.0),
               std::invalid_argument);
}

TEST(BoneCameraTest, ZoomMakesThingsAsManyTimesAsLarge) {
  const Eigen::Vector3d point = kCamera.target + 0.004 * kCamera.pose().linear().col(1);
  const double before = clip(view_of(kCamera, 1.0), point).y();
  EXPECT_NEAR(clip(view_of(zoomed(kCamera, 3.0), 1.0), point).y(), 3.0 * before, 1e-9);
}

TEST(BoneCameraTest, AStereoPairConvergesWhereItIsToldTo) {
  const StereoPair pair{0.02, 0.25};
  const Eigen::Matrix3d axes = kCamera.pose().linear();
  for (const double distance : {0.15, 0.25, 0.5}) {
    const Eigen::Vector3d point =
        kCamera.eye - distance * axes.col(2) + 0.01 * axes.col(0) + 0.004 * axes.col(1);
    const Eigen::Vector3d left = clip(stereo_view_of(kCamera, pair, -1, 1.2), point);
    const Eigen::Vector3d right = clip(stereo_view_of(kCamera, pair, 1, 1.2), point);
    // Similar triangles: b (1 / c - 1 / d) over the half width of the picture at distance 1.
    const double expected = 0.02 * (1.0 / 0.25 - 1.0 / distance) / (1.2 * std::tan(0.2));
    EXPECT_NEAR(right.x() - left.x(), expected, 1e-9);
    EXPECT_NEAR(right.y(), left.y(), 1e-12);
  }
  const EyeView same = stereo_view_of(kCamera, {0.0, 0.3}, 1, 1.2);
  EXPECT_NEAR((same.projection - view_of(kCamera, 1.2).projection).norm(), 0.0, 1e-12);
}

}  // namespace
}  // namespace haptrial::render
