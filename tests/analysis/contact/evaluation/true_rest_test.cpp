// The exact rest of a hard tool: by laws of statics, and by trying whether any pose near it is
// better.

#include "analysis/contact/truth/true_rest.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace haptrial::evaluation::true_rest_test {
namespace {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Vector3d;

std::vector<Vector3d> corners_of(const Vector3d& box) {
  std::vector<Vector3d> corners;
  for (int i = 0; i < 8; ++i) {
    corners.emplace_back(
        0.5 * box.cwiseProduct(Vector3d(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1)));
  }
  return corners;
}

Isometry3d pose(const Vector3d& at, double angle, const Vector3d& axis) {
  Isometry3d pose = Isometry3d::Identity();
  pose.linear() = AngleAxisd(angle, axis.normalized()).toRotationMatrix();
  pose.translation() = at;
  return pose;
}

const std::vector<Vector3d> kCorners = corners_of({0.03, 0.02, 0.04});
const std::vector<HalfSpace> kGround{{Vector3d::UnitY(), 0.0}};

TEST(TrueRestTest, NothingIsFeltInTheAir) {
  const std::vector<Isometry3d> hand{pose({0.0, 0.05, 0.0}, 0.3, {1.0, 2.0, 3.0})};
  const TrueRest rest = true_rests(kCorners, kGround, hand, {}).front();
  EXPECT_EQ(0.0, rest.force.norm());
  EXPECT_NEAR(0.0, rest.torque.norm(), 1e-12);
}

TEST(TrueRestTest, AFaceOnThePlaneIsHeldByTheSpringAlone) {
  const std::vector<Isometry3d> hand{pose({0.0, 0.02, 0.0}, 0.0, Vector3d::UnitX()),
                                     pose({0.01, 0.004, 0.0}, 0.0, Vector3d::UnitX())};
  const TrueRest rest = true_rests(kCorners, kGround, hand, {}).back();
  EXPECT_NEAR(0.0, (rest.force - Vector3d(0.0, 500.0 * 0.006, 0.0)).norm(), 1e-5);
  EXPECT_NEAR(0.0, rest.torque.norm(), 1e-7);
}

/// The force acts at the one corner that touches, so that its lever gives the torque.
TEST(TrueRestTest, TheTorqueIsThatOfTheCornerThatTouches) {
  const Vector3d axis(1.0, 0.4, 0.7);
  const std::vector<Isometry3d> hand{pose({0.0, 0.06, 0.0}, 0.5, axis),
                                     pose({0.0, 0.015, 0.0}, 0.5, axis)};
  const TrueRest rest = true_rests(kCorners, kGround, hand, {}).back();
  const auto lowest = std::ranges::min(
      kCorners, {}, [&](const Vector3d& corner) { return (rest.tool * corner).y(); });
  EXPECT_NEAR(0.0, (rest.tool * lowest).y(), 1e-9);
  const Vector3d lever = rest.tool.linear() * lowest;
  EXPECT_GT(rest.force.y(), 0.5);
  EXPECT_NEAR(0.0, (lever.cross(rest.force) - rest.torque).norm(), 1e-6);
}

double energy(const Isometry3d& tool, const Isometry3d& hand, const HandSprings& springs) {
  const AngleAxisd turn(tool.linear() * hand.linear().transpose());
  return 0.5 * springs.stiffness * (tool.translation() - hand.translation()).squaredNorm() +
         0.5 * springs.turning_stiffness * turn.angle() * turn.angle();
}

double spare_of(const Isometry3d& tool, const std::vector<HalfSpace>& free) {
  double spare = 1.0;
  for (const Vector3d& corner : kCorners) {
    for (const HalfSpace& half : free) {
      spare = std::min(spare, half.normal.dot(tool * corner) - half.offset);
    }
  }
  return spare;
}

TEST(TrueRestTest, NoFreePoseNearbyHasLessEnergy) {
  const double flank = 0.6;
  const std::vector<HalfSpace> groove{{{std::sin(flank), std::cos(flank), 0.0}, 0.0},
                                      {{-std::sin(flank), std::cos(flank), 0.0}, 0.0}};
  const Vector3d axis(0.2, 0.1, 1.0);
  const std::vector<Isometry3d> hand{pose({0.0, 0.06, 0.0}, 0.7, axis),
                                     pose({0.004, 0.012, 0.0}, 0.9, axis)};
  const TrueRest rest = true_rests(kCorners, groove, hand, {}).back();
  EXPECT_GT(spare_of(rest.tool, groove), -1e-9);
  const double least = energy(rest.tool, hand.back(), {});
  ASSERT_GT(least, 1e-4);
  int tried = 0;
  for (int i = 0; i < 20000; ++i) {
    const auto wave = [&](double rate) { return std::sin(rate * i + rate); };
    const double size = 1e-4 * (1.0 + i % 10);
    Isometry3d other = rest.tool;
    other.translation() += size * Vector3d(wave(1.1), wave(1.7), wave(2.3));
    const Vector3d turn = 30.0 * size * Vector3d(wave(2.9), wave(3.1), wave(3.7));
    other.linear() =
        AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix() * rest.tool.linear();
    if (spare_of(other, groove) >= 0.0) {
      ++tried;
      ASSERT_GT(energy(other, hand.back(), {}), least - 1e-9);
    }
  }
  EXPECT_GT(tried, 1000);
}

}  // namespace
}  // namespace haptrial::evaluation::true_rest_test
