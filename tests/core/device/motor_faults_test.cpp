// Planted faults of the virtual device, and the mount that measures them.

#include "core/device/motor_faults.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "core/device/sensed_mount.h"
#include "core/device/virtual_device.h"
#include "tests/support/allocation_guard.h"

namespace haptrial::device::motor_faults_test {
namespace {

using Eigen::Vector3d;

constexpr double kPeriod = 0.001;  // [s]
constexpr double kPi = std::numbers::pi;

TEST(MotorFaultsTest, WithoutFaultsTheCommandIsTheForce) {
  FaultyMotors motors({}, kPeriod);
  const Vector3d command(1.0, -2.0, 0.5);
  EXPECT_EQ(motors.force(command, {0.01, 0.02, 0.03}), command);
}

TEST(MotorFaultsTest, GainDeadZoneCoggingAndGravityAreAsPlanted) {
  MotorFaults faults;
  faults.gain = 0.87;
  faults.dead_zone = 0.5;
  FaultyMotors weak(faults, kPeriod);
  EXPECT_TRUE(weak.force({0.3, 0.0, 0.39}, Vector3d::Zero()).isZero());
  EXPECT_TRUE(weak.force({3.0, 0.0, 4.0}, Vector3d::Zero())
                  .isApprox(0.87 * 4.5 * Vector3d(0.6, 0.0, 0.8), 1e-12));
  MotorFaults rest;
  rest.cogging = 0.1;
  rest.cogging_period = 0.002;
  rest.gravity_error = -0.2;
  FaultyMotors motors(rest, kPeriod);
  const Vector3d force = motors.force(Vector3d::Zero(), {0.0005, 0.0, 0.0015});
  EXPECT_NEAR(force.x(), -0.1, 1e-12);
  EXPECT_NEAR(force.y(), -0.2, 1e-12);
  EXPECT_NEAR(force.z(), 0.1, 1e-12);
}

TEST(MotorFaultsTest, AStepThroughTheResonanceIsThatOfTheTextbook) {
  for (const double damping : {0.1, 0.999999, 1.0, 1.5}) {
    MotorFaults faults;
    faults.resonance = 40.0;
    faults.resonance_damping = damping;
    FaultyMotors motors(faults, kPeriod);
    // y'' = w² (1 - y) - 2 z w y' in steps a hundred times as short.
    const double w = 2.0 * kPi * faults.resonance;
    double y = 0.0, v = 0.0;
    for (int tick = 0; tick < 60; ++tick) {
      for (int i = 0; i < 2000; ++i) {
        const double h = kPeriod / 2000;
        const double middle = v + 0.5 * h * (w * w * (1.0 - y) - 2.0 * damping * w * v);
        y += h * middle;
        v = middle + 0.5 * h * (w * w * (1.0 - y) - 2.0 * damping * w * middle);
      }
      EXPECT_NEAR(motors.force({1.0, 0.0, 0.0}, Vector3d::Zero()).x(), y, 1e-4) << damping;
    }
  }
}

TEST(MotorFaultsTest, FaultsOutOfBoundsAreRefused) {
  const auto refused = [](auto change) {
    MotorFaults faults;
    change(faults);
    EXPECT_THROW(FaultyMotors(faults, kPeriod), std::invalid_argument);
  };
  refused([](MotorFaults& f) { f.gain = 0.0; });
  refused([](MotorFaults& f) { f.dead_zone = -0.1; });
  refused([](MotorFaults& f) { f.resonance = NAN; });
  refused([](MotorFaults& f) { f.cogging_period = 0.0; });
  refused([](MotorFaults& f) { f.gravity_error = INFINITY; });
}

TEST(SensedMountTest, MeasuresMotorsFrictionAndInertiaOfAHeldHandle) {
  SensedMountParameters p;
  p.mass = 0.5;
  p.friction = 0.3;
  p.noise = 0.0;
  SensedMount mount(p, 1);
  MeasuredForce measured;
  for (int tick = 1; tick <= 20; ++tick) {  // x = t²
    const double t = kPeriod * tick;
    mount.hold({t * t, 0.0, 0.0});
    mount.step({1.0, 2.0, 0.0}, kPeriod);
  }
  ASSERT_TRUE(mount.read(measured));
  EXPECT_NEAR(measured.force.x(), 1.0 - 0.3 - 0.5 * 2.0, 1e-6);
  EXPECT_NEAR(measured.force.y(), 2.0, 1e-9) << "it stands still along y";
  EXPECT_NEAR(mount.state().velocity.x(), 2.0 * 0.020, 1e-9);
}

TEST(SensedMountTest, AFreeHandleFallsAsItsMassAndFrictionSay) {
  SensedMountParameters p;
  p.mass = 0.2;
  p.friction = 0.3;
  p.added_mass = 0.3;
  SensedMount mount(p, 1);
  mount.release();
  MeasuredForce measured;
  EXPECT_FALSE(mount.read(measured)) << "nothing holds it";
  for (int tick = 0; tick < 100; ++tick) {
    mount.step({1.3, 0.2, 0.0}, kPeriod);
  }
  EXPECT_NEAR(mount.state().velocity.x(), 1.0 / 0.5 * 0.1, 1e-9);
  EXPECT_NEAR(mount.state().position.x(), 0.5 * 1.0 / 0.5 * 0.01, 1e-9);
  EXPECT_EQ(mount.state().position.y(), 0.0) << "less than the friction";
}

TEST(SensedMountTest, StepsAndReadingsDoNotAllocate) {
  SensedMount mount({}, 1);
  VirtualDeviceParameters p;
  p.faults.resonance = 80.0;
  p.faults.cogging = 0.1;
  VirtualDevice device(p, mount, 1000.0);
  MeasuredForce measured;
  DeviceReading reading;
  const test::AllocationGuard guard;
  for (int tick = 0; tick < 100; ++tick) {
    device.read(reading);
    mount.read(measured);
    mount.hold({1e-5 * tick, 0.0, 0.0});
    device.write(Eigen::Vector3d(1.0, 0.0, 0.0));
  }
  EXPECT_EQ(guard.count(), 0u);
}

}  // namespace
}  // namespace haptrial::device::motor_faults_test
