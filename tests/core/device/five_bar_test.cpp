// Kinematics of a pantograph against closed forms of their own, differences and virtual work.

#include "core/device/five_bar.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace haptrial::device {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

/// The triangle of motor, elbow and handle on each side, by the law of cosines.
Vector2d angles_at(const FiveBar& bars, const Vector2d& handle) {
  const auto bend = [&](double reach) {
    return std::acos((bars.arm * bars.arm + reach * reach - bars.forearm * bars.forearm) /
                     (2.0 * bars.arm * reach));
  };
  const Vector2d second = handle - Vector2d(bars.base, 0.0);
  return {std::atan2(handle.y(), handle.x()) + bend(handle.norm()),
          std::atan2(second.y(), second.x()) - bend(second.norm())};
}

const FiveBar kMechanisms[]{{0.038, 0.07, 0.09}, {0.0, 0.07, 0.09}, {0.1, 0.08, 0.12}};

/// Handles over the workspace of each mechanism.
template <class Check>
void over_the_workspace(const Check& check) {
  for (const FiveBar& bars : kMechanisms) {
    const Vector2d center{0.5 * bars.base, 0.1};
    for (int i = -4; i <= 4; ++i) {
      for (int j = -4; j <= 4; ++j) {
        check(bars, Vector2d(center + 0.0085 * Vector2d(i, j)));
      }
    }
  }
}

TEST(FiveBarTest, TheHandleIsWhereTheInverseKinematicsSaysSo) {
  over_the_workspace([](const FiveBar& bars, const Vector2d& handle) {
    const FiveBarPose pose = solve_five_bar(bars, angles_at(bars, handle));
    ASSERT_TRUE(pose.regular) << handle.transpose();
    EXPECT_LT((pose.handle - handle).norm(), 1e-12);
  });
}

TEST(FiveBarTest, TheJacobianInvertsTheDerivativeOfTheInverseKinematics) {
  static constexpr double kStep = 1e-5;
  over_the_workspace([](const FiveBar& bars, const Vector2d& handle) {
    Matrix2d turn;  // of the angles with the handle
    for (int axis = 0; axis < 2; ++axis) {
      const Vector2d way = kStep * Vector2d::Unit(axis);
      turn.col(axis) =
          (angles_at(bars, handle + way) - angles_at(bars, handle - way)) / (2.0 * kStep);
    }
    const Matrix2d jacobian = solve_five_bar(bars, angles_at(bars, handle)).jacobian;
    EXPECT_LT((jacobian * turn - Matrix2d::Identity()).norm(), 1e-5) << handle.transpose();
  });
}

/// The motors give on a small way what the handle receives.
TEST(FiveBarTest, TorquesDoTheWorkOfTheForce) {
  over_the_workspace([](const FiveBar& bars, const Vector2d& handle) {
    const Vector2d force{1.3, -0.7};
    const Vector2d way = 1e-6 * Vector2d(0.4, 0.9);
    const Vector2d turned =
        angles_at(bars, handle + 0.5 * way) - angles_at(bars, handle - 0.5 * way);
    const Vector2d torques =
        solve_five_bar(bars, angles_at(bars, handle)).jacobian.transpose() * force;
    EXPECT_NEAR(torques.dot(turned), force.dot(way), 1e-6 * force.norm() * way.norm());
  });
}

TEST(FiveBarTest, WhereNoForceIsDefinedThePoseSaysSo) {
  const double right = 0.5 * std::numbers::pi;
  const auto is_regular = [](const FiveBar& bars, double first, double second) {
    const FiveBarPose pose = solve_five_bar(bars, {first, second});
    EXPECT_TRUE(pose.regular || (pose.jacobian.isZero(0.0) && pose.handle.isZero(0.0)));
    return pose.regular;
  };
  EXPECT_TRUE(is_regular({0.038, 0.07, 0.09}, 2.5, 0.6));
  EXPECT_FALSE(is_regular({0.0399, 0.07, 0.09}, 2.0 * right, 0.0)) << "forearms all but in line";
  EXPECT_FALSE(is_regular({0.2, 0.07, 0.09}, 3.1, 0.0)) << "too far apart";
  EXPECT_FALSE(is_regular({0.0, 0.07, 0.09}, right, right)) << "one on the other";
  EXPECT_FALSE(is_regular({0.0, 0.07, 0.09}, right + 0.05, right)) << "all but on each other";
  EXPECT_FALSE(is_regular({0.038, 0.07, 0.09}, std::numeric_limits<double>::quiet_NaN(), 0.6));
  EXPECT_FALSE(is_regular({0.038, 0.07, 0.09}, 2.5, std::numeric_limits<double>::infinity()));
}

/// Close to where forces go off, the torques of 1 N are still those of some arms' lengths.
TEST(FiveBarTest, TorquesStayWithinBoundsWhereverForcesAreDefined) {
  const FiveBar bars{0.038, 0.07, 0.09};
  double largest = 0.0;
  for (int i = 0; i < 360; ++i) {
    for (int j = 0; j < 360; ++j) {
      const double degree = std::numbers::pi / 180.0;
      largest = std::max(largest, solve_five_bar(bars, degree * Vector2d(i, j)).jacobian.norm());
    }
  }
  EXPECT_GT(largest, bars.arm);
  EXPECT_LT(largest, 2.0 * bars.arm / std::sin(10.0 * std::numbers::pi / 180.0));
}

}  // namespace
}  // namespace haptrial::device
