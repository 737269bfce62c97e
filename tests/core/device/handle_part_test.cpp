#include "core/device/handle_part.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace haptrial::device {
namespace {

using Eigen::Vector3d;

constexpr double kRadius = 0.02;  // [m]

TEST(HandlePartTest, ARotationIsFollowedOverWholeTurnsInBothDirections) {
  for (const double way : {1.0, -1.0}) {
    for (const Vector3d& axis : {Vector3d(0.0, 1.0, 0.0), Vector3d(0.6, 0.0, -0.8)}) {
      Vector3d phi = Vector3d::Zero();
      for (int i = 0; i <= 3000; ++i) {
        const double angle = way * 0.01 * i;  // to 30 rad, almost five turns
        const Eigen::Quaterniond turned(Eigen::AngleAxisd(angle, axis));
        // Both signs of a quaternion are the same rotation.
        phi = rotation_near(i % 2 == 0 ? turned : Eigen::Quaterniond(-turned.coeffs()), phi);
        ASSERT_LT((phi - angle * axis).norm(), 1e-9) << angle;
      }
    }
  }
}

TEST(HandlePartTest, ASmallRotationAboutAnyAxisIsTheVectorOfItsAngles) {
  const Vector3d angles(1e-5, -2e-5, 3e-5);
  const Eigen::Quaterniond turned(Eigen::AngleAxisd(angles.norm(), angles.normalized()));
  EXPECT_LT((rotation_near(turned, Vector3d::Zero()) - angles).norm(), 1e-12);
}

TEST(HandlePartTest, TheForceAtTheFingersDoesTheWorkOfTheTorque) {
  // Power is torque times angular velocity, and force times velocity at the fingers.
  DeviceReading reading;
  reading.orientation = Eigen::AngleAxisd(0.4, Vector3d::UnitZ());
  reading.angular_velocity = {0.3, -0.2, 1.5};
  const PointState state = part_state(Part::kRotation, reading, kRadius, Vector3d::Zero());
  EXPECT_NEAR(state.position.z(), 0.4 * kRadius, 1e-12);
  const Vector3d force(1.0, 2.0, -0.5);
  Wrench wrench;
  put_force(Part::kRotation, force, kRadius, wrench);
  EXPECT_NEAR(wrench.torque.dot(reading.angular_velocity), force.dot(state.velocity), 1e-15);
  EXPECT_TRUE(wrench.force.isZero(0.0));
  EXPECT_EQ(wrench.grip, 0.0);
}

TEST(HandlePartTest, AGripIsItsOpeningAlongX) {
  DeviceReading reading;
  reading.opening = 0.013;
  reading.opening_speed = -0.2;
  const PointState state = part_state(Part::kGrip, reading, 1.0, Vector3d::Zero());
  EXPECT_EQ(state.position, Vector3d(0.013, 0.0, 0.0));
  EXPECT_EQ(state.velocity, Vector3d(-0.2, 0.0, 0.0));
  Wrench wrench;
  put_force(Part::kGrip, {3.0, 9.0, 9.0}, 1.0, wrench);
  EXPECT_EQ(wrench.grip, 3.0);
}

TEST(HandlePartTest, ADeviceWithoutTorqueAndGripGivesNone) {
  const DeviceInfo info;
  EXPECT_TRUE(part_axes(Part::kRotation, info).isZero(0.0));
  EXPECT_TRUE(part_axes(Part::kGrip, info).isZero(0.0));
  EXPECT_EQ(most_force(Part::kRotation, info, kRadius), 0.0);
  EXPECT_EQ(most_force(Part::kGrip, info, 1.0), 0.0);
}

}  // namespace
}  // namespace haptrial::device
