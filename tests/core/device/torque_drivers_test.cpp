// Torque and grip of the makers' devices, over stand-in libraries: axes, signs, limits, and devices
// or libraries that have none.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/device/force_dimension.h"
#include "core/device/open_haptics.h"
#include "tests/core/device/device_rigs.h"
#include "tests/support/message_of.h"

namespace haptrial::device {
namespace {

using Eigen::Vector3d;
using test::kRigRate;
using test::message_of;
using test::StandIn;
using testing::AllOf;
using testing::HasSubstr;

/// A wrench whose six numbers and grip force differ.
Wrench some_wrench() {
  Wrench wrench(Vector3d(1.0, 2.0, 3.0));
  wrench.torque = {0.01, 0.02, 0.03};
  wrench.grip = 1.5;
  return wrench;
}

TEST(ForceDimensionPartsTest, AWrenchReachesTheMotorsInTheVendorsAxes) {
  const StandIn stand_in("stand_in_dhd");
  stand_in.activate();
  ForceDimensionDevice device({}, kRigRate, stand_in.path);
  ASSERT_TRUE(device.write(some_wrench()));
  const test::StandInView seen = stand_in.look();
  EXPECT_THAT(seen.force, testing::ElementsAre(3.0, 1.0, 2.0)) << "to the user, right, up";
  EXPECT_THAT(seen.torque, testing::ElementsAre(0.03, 0.01, 0.02));
  EXPECT_EQ(seen.grip, 1.5);
}

// A torque turns the handle about its own axis, whatever the axes are called: work is positive.
TEST(ForceDimensionPartsTest, AHandleTurnsTheWayOfItsTorqueAndOpensTheWayOfItsGripForce) {
  for (int axis = 0; axis < 3; ++axis) {
    const StandIn stand_in("stand_in_dhd");
    stand_in.activate();
    ForceDimensionDevice device({}, kRigRate, stand_in.path);
    Wrench wrench;
    wrench.torque[axis] = 0.01;
    wrench.grip = 1.0;
    DeviceReading first, last;
    ASSERT_TRUE(device.read(first));
    for (int i = 0; i < 20; ++i) {
      ASSERT_TRUE(device.write(wrench));
      ASSERT_TRUE(device.read(last));
    }
    EXPECT_GT(last.angular_velocity[axis], 0.1);
    EXPECT_NEAR(last.angular_velocity.norm(), last.angular_velocity[axis], 1e-9);
    const Eigen::AngleAxisd turned(last.orientation);
    EXPECT_GT((turned.angle() * turned.axis())[axis], 1e-3);
    EXPECT_GT(last.opening, first.opening);
    EXPECT_GT(last.opening_speed, 0.0);
  }
}

TEST(ForceDimensionPartsTest, LimitsAndWindowsAreSetAtTheStart) {
  const StandIn stand_in("stand_in_dhd");
  stand_in.activate();
  ForceDimensionParameters p;
  p.max_torque = 0.15;
  p.max_grip_force = 5.0;
  p.velocity_window = 0.012;
  const ForceDimensionDevice device(p, kRigRate, stand_in.path);
  EXPECT_EQ(stand_in.setup().max_torque, 0.15);
  EXPECT_EQ(stand_in.setup().max_grip_force, 5.0);
  EXPECT_EQ(stand_in.setup().angular_window_ms, 12);
  EXPECT_EQ(stand_in.setup().gripper_window_ms, 12);
  EXPECT_EQ(device.info().max_torque, 0.15);
  EXPECT_EQ(device.info().max_grip_force, 5.0);
  EXPECT_EQ(device.info().torque_axes, Vector3d::Ones());
  EXPECT_TRUE(device.info().senses_orientation);
}

TEST(ForceDimensionPartsTest, ADefinitionMayNotClaimMoreThanTheModelGives) {
  const StandIn stand_in("stand_in_dhd");
  stand_in.activate();
  ForceDimensionParameters p;
  p.max_torque = 0.3;
  EXPECT_THAT(message_of<InputError>([&] { ForceDimensionDevice(p, kRigRate, stand_in.path); }),
              AllOf(HasSubstr("max_torque is 0.3 N·m"), HasSubstr("at most 0.2 N·m")));
  p.max_torque = 0.1;
  p.max_grip_force = 9.0;
  EXPECT_THAT(message_of<InputError>([&] { ForceDimensionDevice(p, kRigRate, stand_in.path); }),
              AllOf(HasSubstr("max_grip_force is 9 N"), HasSubstr("at most 8 N")));
}

TEST(ForceDimensionPartsTest, ADeviceWithoutTheseMotorsGivesAForceAlone) {
  const StandIn stand_in("stand_in_dhd");
  ForceDimensionDevice device({}, kRigRate, stand_in.path);
  EXPECT_EQ(device.info().max_torque, 0.0);
  EXPECT_EQ(device.info().max_grip_force, 0.0);
  ASSERT_TRUE(device.write(some_wrench()));
  EXPECT_THAT(stand_in.look().torque, testing::Each(0.0));
  EXPECT_EQ(stand_in.look().grip, 0.0);
}

TEST(OpenHapticsPartsTest, ADeviceWithSixMotorsTakesATorqueInItsOwnUnit) {
  const StandIn stand_in("stand_in_hd");
  stand_in.manual(1);
  stand_in.activate();
  OpenHapticsDevice device({}, kRigRate, stand_in.path);
  EXPECT_EQ(device.info().max_torque, 0.1) << "the driver's limit is below the device's 0.515 N·m";
  ASSERT_TRUE(device.write(some_wrench()));
  stand_in.step();
  EXPECT_NEAR(stand_in.look().torque[1], 0.02, 1e-12);
  for (int i = 0; i < 20; ++i) {
    ASSERT_TRUE(device.write(some_wrench()));
    stand_in.step();
  }
  DeviceReading reading;
  ASSERT_TRUE(device.read(reading));
  EXPECT_GT(reading.angular_velocity.z(), reading.angular_velocity.x());
  EXPECT_GT(reading.angular_velocity.x(), 0.0);
}

TEST(OpenHapticsPartsTest, SilenceTakesTheTorqueAwayToo) {
  const StandIn stand_in("stand_in_hd");
  stand_in.manual(1);
  stand_in.activate();
  OpenHapticsDevice device({}, kRigRate, stand_in.path);
  ASSERT_TRUE(device.write(some_wrench()));
  for (int i = 0; i < 30; ++i) {
    stand_in.step();
  }
  EXPECT_THAT(stand_in.look().torque, testing::Each(0.0));
}

TEST(OpenHapticsPartsTest, ADeviceWithThreeMotorsGivesAForceAlone) {
  const StandIn stand_in("stand_in_hd");
  stand_in.manual(1);
  OpenHapticsDevice device({}, kRigRate, stand_in.path);
  EXPECT_EQ(device.info().max_torque, 0.0);
  EXPECT_TRUE(device.info().torque_axes.isZero(0.0));
}

}  // namespace
}  // namespace haptrial::device
