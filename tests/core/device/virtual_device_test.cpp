#include "core/device/virtual_device.h"

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include <cmath>
#include <limits>
#include <vector>

#include "core/base/definition/schema.h"
#include "core/base/error.h"
#include "core/base/random.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/free_mass.h"

namespace haptrial::device::virtual_device_test {
namespace {

using Eigen::Vector3d;
constexpr double kRate = 1000.0;
constexpr double kPeriod = 1.0 / kRate;

/// Notes the forces that it is given and goes where it is told.
class ScriptedHandle final : public HandlePhysics {
 public:
  PointState step(const Vector3d& force, double dt) noexcept override {
    forces.push_back(force);
    steps.push_back(dt);
    state_.position = next;
    return state_;
  }
  PointState state() const noexcept override { return state_; }
  std::vector<Vector3d> forces;
  std::vector<double> steps;
  Vector3d next{Vector3d::Zero()};

 private:
  PointState state_;
};

DeviceReading reading_of(VirtualDevice& device) {
  DeviceReading reading;
  EXPECT_TRUE(device.read(reading));
  return reading;
}

TEST(VirtualDeviceTest, SaysThatItIsSimulated) {
  ScriptedHandle handle;
  VirtualDevice device({}, handle, kRate);
  EXPECT_TRUE(device.info().simulated);
  EXPECT_EQ(device.info().max_force, 12.0);
  EXPECT_EQ(device.info().workspace_radius, 0.075);
  EXPECT_FALSE(device.info().name.empty());
}

TEST(VirtualDeviceTest, TheForceOfATickActsInTheNextPeriod) {
  ScriptedHandle handle;
  VirtualDevice device({}, handle, kRate);
  for (int k = 1; k <= 5; ++k) {
    ASSERT_TRUE(device.write(Eigen::Vector3d(0.0, k * 1.0, 0.0)));
  }
  ASSERT_EQ(handle.forces.size(), 5u) << "one period a write";
  for (int k = 0; k < 5; ++k) {
    EXPECT_EQ(handle.forces[k], Vector3d(0.0, k * 1.0, 0.0)) << k;
    EXPECT_EQ(handle.steps[k], kPeriod);
  }
}

TEST(VirtualDeviceTest, MotorsSaturateAndKeepTheDirection) {
  ScriptedHandle handle;
  VirtualDevice device({}, handle, kRate);
  device.write(Eigen::Vector3d(0.0, 30.0, -40.0));
  device.write(Eigen::Vector3d(0.0, 7.2, 9.6));
  device.write(Vector3d::Zero());
  EXPECT_LT((handle.forces[1] - Vector3d(0.0, 7.2, -9.6)).norm(), 1e-12);
  EXPECT_EQ(handle.forces[2], Vector3d(0.0, 7.2, 9.6)) << "the limit itself is not touched";
}

TEST(VirtualDeviceTest, PositionIsRoundedToTheQuantum) {
  ScriptedHandle handle;
  VirtualDevice device({}, handle, kRate);
  RandomStream random(1, "quantum");
  for (int i = 0; i < 1000; ++i) {
    handle.next = {random.uniform(-0.05, 0.05), random.uniform(-0.05, 0.05), -1.49e-5};
    device.write(Vector3d::Zero());
    const Vector3d read = reading_of(device).tool.position;
    for (int axis = 0; axis < 3; ++axis) {
      const double counts = read[axis] / 1e-5;
      ASSERT_NEAR(counts, std::round(counts), 1e-9);
      ASSERT_LE(std::abs(read[axis] - handle.next[axis]), 0.5e-5 * (1 + 1e-9));
    }
  }
  EXPECT_DOUBLE_EQ(reading_of(device).tool.position.z(), -1e-5);
}

TEST(VirtualDeviceTest, WithoutAQuantumPositionIsExact) {
  VirtualDeviceParameters exact;
  exact.position_quantum = 0.0;
  ScriptedHandle handle;
  VirtualDevice device(exact, handle, kRate);
  handle.next = {0.0123456789, -1e-9, 0.02};
  device.write(Vector3d::Zero());
  EXPECT_EQ(reading_of(device).tool.position, handle.next);
}

TEST(VirtualDeviceTest, RestsAtFirstWhereverTheHandleIs) {
  test::FreeMass mass(0.3, {{0.01, 0.02, 0.03}, {0.0, 0.0, 0.0}});
  VirtualDevice device({}, mass, kRate);
  EXPECT_LT((reading_of(device).tool.position - Vector3d(0.01, 0.02, 0.03)).norm(), 1e-15);
  EXPECT_LT(reading_of(device).tool.velocity.norm(), 1e-12) << "not thrown from the origin";
}

TEST(VirtualDeviceTest, VelocityOfASteadyHandleIsItsSlope) {
  const Vector3d velocity{0.016, -0.3, 0.001};
  for (const double quantum : {0.0, 1e-5}) {
    for (const int window : {2, 3, 8, 64}) {
      VirtualDeviceParameters p;
      p.position_quantum = quantum;
      p.velocity_window = window;
      test::FreeMass mass(1.0, {{0, 0, 0}, velocity});
      VirtualDevice device(p, mass, kRate);
      for (int i = 0; i < 200; ++i) {
        device.write(Vector3d::Zero());
        if (i < window) {
          continue;  // the window still holds readings from before the start
        }
        // Each reading is off by at most half a quantum; the slope then by about 1.5 / n quanta a
        // period (1 for n = 2).
        const double bound = 2.25 / window * quantum / kPeriod + 1e-10;
        const Vector3d error = reading_of(device).tool.velocity - velocity;
        ASSERT_LE(error.cwiseAbs().maxCoeff(), bound) << quantum << " " << window << " " << i;
      }
    }
  }
}

TEST(VirtualDeviceTest, VelocityIsTheLeastSquaresSlopeOfTheLastReadings) {
  RandomStream random(2, "slope");
  for (const int window : {2, 5, 8, 33}) {
    VirtualDeviceParameters p;
    p.velocity_window = window;
    ScriptedHandle handle;
    VirtualDevice device(p, handle, kRate);
    std::vector<double> readings;
    for (int i = 0; i < 3 * window; ++i) {
      handle.next = {random.uniform(-0.05, 0.05), 0.0, 0.0};
      device.write(Vector3d::Zero());
      readings.push_back(reading_of(device).tool.position.x());
    }
    Eigen::MatrixXd line(window, 2);
    Eigen::VectorXd x(window);
    for (int i = 0; i < window; ++i) {
      line.row(i) << 1.0, i * kPeriod;
      x[i] = readings[readings.size() - window + i];
    }
    const Eigen::VectorXd fit = line.colPivHouseholderQr().solve(x);
    EXPECT_NEAR(reading_of(device).tool.velocity.x(), fit[1], 1e-9 * std::abs(fit[1]) + 1e-9)
        << window;
  }
}

TEST(VirtualDeviceTest, AFreeMassFollowsTheExactIntegral) {
  constexpr double kMass = 0.25;
  VirtualDeviceParameters exact;
  exact.position_quantum = 0.0;
  test::FreeMass mass(kMass);
  VirtualDevice device(exact, mass, kRate);
  constexpr double kForce = 2.0;
  for (int k = 1; k <= 200; ++k) {
    device.write(Eigen::Vector3d(kForce, 0.0, 0.0));
    const double t = (k - 1) * kPeriod;  // the first force arrives one period later
    EXPECT_NEAR(reading_of(device).tool.position.x(), 0.5 * kForce / kMass * t * t, 1e-12) << k;
  }
}

TEST(VirtualDeviceTest, ATickDoesNotAllocate) {
  test::FreeMass mass(0.3);
  VirtualDevice device({}, mass, kRate);
  DeviceReading reading;
  const test::AllocationGuard guard;
  for (int i = 0; i < 1000; ++i) {
    device.read(reading);
    device.write(Eigen::Vector3d(0.0, 20.0, 0.0));
  }
  EXPECT_EQ(guard.count(), 0u);
}

TEST(VirtualDeviceTest, ParametersOutOfBoundsAreRefused) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  ScriptedHandle handle;
  const auto refused = [&](auto change, double rate) {
    VirtualDeviceParameters p;
    change(p);
    EXPECT_THROW(VirtualDevice(p, handle, rate), std::invalid_argument);
  };
  for (const double rate : {0.0, -1.0, kNan}) {
    refused([](auto&) {}, rate);
  }
  for (const int window : {-1, 0, 1, 65}) {
    refused([&](auto& p) { p.velocity_window = window; }, kRate);
  }
  refused([](auto& p) { p.max_force = 0.0; }, kRate);
  refused([](auto& p) { p.max_force = kNan; }, kRate);
  refused([](auto& p) { p.position_quantum = -1e-5; }, kRate);
  refused([](auto& p) { p.position_quantum = kNan; }, kRate);
}

TEST(VirtualDeviceTest, ParametersAreReadWithTheirBounds) {
  Table good = Table::parse(
      "max_force = 8.0\nworkspace_radius = 0.05\nposition_quantum = 0.0\nvelocity_window = 64\n",
      "f.toml");
  const VirtualDeviceParameters p = virtual_device_schema().read(good);
  EXPECT_NO_THROW(good.finish());
  ScriptedHandle handle;
  EXPECT_EQ(VirtualDevice(p, handle, kRate).info().max_force, 8.0);
  Table bad = Table::parse(
      "max_force = 8.0\nworkspace_radius = 0.05\nposition_quantum = 0.0\nvelocity_window = 65\n",
      "f.toml");
  virtual_device_schema().read(bad);
  EXPECT_THROW(bad.finish(), InputError);
}

}  // namespace
}  // namespace haptrial::device::virtual_device_test
