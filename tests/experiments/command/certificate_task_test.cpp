#include "experiments/command/sessions/certificate_task.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

#include "analysis/device/excitation.h"
#include "core/device/fault.h"
#include "core/device/sensed_mount.h"
#include "core/device/virtual_device.h"
#include "tests/support/scripted_device.h"

namespace haptrial::experiments {
namespace {

using analysis::CertificatePart;

/// A handle that swings 10 mm about the place beyond which it is caught, at up to 0.5 m/s.
bool swing_about_the_edge(std::size_t tick, device::DeviceReading& reading) {
  constexpr double kEdge = 0.8 * 0.075, kDepth = 0.01;     // [m]
  constexpr double kOmega = 2.0 * std::numbers::pi * 8.0;  // [1/s]
  const double phase = 1e-3 * kOmega * static_cast<double>(tick);
  reading.tool.position.y() = -kEdge + kDepth * std::sin(phase);
  reading.tool.velocity.y() = kDepth * kOmega * std::cos(phase);
  return true;
}

/// The axis is caught first, then driven, then caught again. The tones of the excitation alone make
/// steps of up to 0.33 N.
TEST(CertificateTaskTest, AFreeHandleIsHeldWithoutASteppingForce) {
  test::ScriptedDevice device;
  device.on_read = swing_about_the_edge;
  const analysis::Excitation excitation(1000.0, 4.8);
  CertificateTask task(device, nullptr, excitation, {CertificatePart::kFree},
                       [](CertificatePart, long) {});
  const auto ticks = static_cast<std::size_t>(excitation.ticks(CertificatePart::kFree));
  for (std::size_t tick = 0; tick < ticks; ++tick) {
    task.tick({tick, static_cast<std::int64_t>(1000000 * tick), 1e-3});
  }
  EXPECT_EQ(task.fault(), device::Fault::kNone);
  double step = 0.0, largest = 0.0;
  for (std::size_t tick = 1; tick < ticks; ++tick) {
    const double force = device.written[tick].y();
    step = std::max(step, std::abs(force - device.written[tick - 1].y()));
    largest = std::max(largest, force);
  }
  EXPECT_LT(step, 0.5);
  EXPECT_GT(largest, 0.8) << "80 N/m at 10 mm";
}

/// Whether a handle of 0.22 kg that is let go 3 mm in front of a wall and pressed by 1 N swings on
/// there: each command acts two ticks later, against the friction [N].
bool swings_on(double stiffness, double friction) {
  constexpr double kMass = 0.22, kTick = 1e-3;
  double x = 0.003, v = 0.0;
  std::array<double, 2> late{};
  std::array<double, 3> low{1.0, 1.0, 1.0}, high{-1.0, -1.0, -1.0};
  for (std::size_t tick = 0; tick < 1200; ++tick) {
    const double seen = 1e-5 * std::round(1e5 * x);
    const double command = std::min(stiffness * std::max(-seen, 0.0), 4.0) - 1.0;
    const double force = std::exchange(late[tick % 2], command);
    const double free = v + force / kMass * kTick;
    const double held = friction / kMass * kTick;
    const double next = std::abs(free) > held ? free - std::copysign(held, free) : 0.0;
    x += 0.5 * (v + next) * kTick;
    v = next;
    low[tick / 400] = std::min(low[tick / 400], x);
    high[tick / 400] = std::max(high[tick / 400], x);
  }
  const double middle = high[1] - low[1], last = high[2] - low[2];
  return last > 3e-4 && last > 0.7 * middle;
}

/// Friction must not keep the handle at the wall, where every further one would count as passive.
TEST(CertificateTaskTest, AHandleWithFrictionIsTakenBackFromEachWall) {
  for (const double friction : {0.15, 0.3, 0.5}) {
    device::SensedMount mount({.friction = friction}, 1);
    device::VirtualDeviceParameters electronics;
    electronics.max_force = 12.0;
    electronics.force_delay = 2;
    electronics.position_quantum = 1e-5;
    device::VirtualDevice device(electronics, mount, 1000.0);
    const analysis::Excitation excitation(1000.0, 4.8);
    CertificateTask task(device, nullptr, excitation, {CertificatePart::kWall},
                         [&mount](CertificatePart, long) { mount.release(); });
    std::size_t tick = 0;
    while (task.tick({tick, static_cast<std::int64_t>(1000000 * tick), 1e-3}) && tick < 400'000) {
      ++tick;
    }
    double passive = 0.0, active = 1e9;
    for (const analysis::WallStep& wall : task.record().walls) {
      EXPECT_TRUE(wall.met) << friction << " N at " << wall.stiffness << " N/m";
      (wall.passive ? passive : active) = wall.stiffness;
    }
    double expected = 200.0;
    while (!swings_on(expected, friction)) {
      expected *= 1.01;
    }
    EXPECT_NEAR(passive, expected, 0.15 * expected) << friction;
    EXPECT_NEAR(active, expected, 0.15 * expected) << friction;
  }
}

TEST(CertificateTaskTest, AWallThatThePressDoesNotReachIsNotPassive) {
  device::SensedMount mount({.friction = 1.2}, 1);
  device::VirtualDeviceParameters electronics;
  electronics.max_force = 12.0;
  device::VirtualDevice device(electronics, mount, 1000.0);
  const analysis::Excitation excitation(1000.0, 4.8);
  CertificateTask task(device, nullptr, excitation, {CertificatePart::kWall},
                       [&mount](CertificatePart, long) { mount.release(); });
  std::size_t tick = 0;
  while (task.tick({tick, static_cast<std::int64_t>(1000000 * tick), 1e-3}) && tick < 400'000) {
    ++tick;
  }
  const std::vector<analysis::WallStep> walls = task.record().walls;
  ASSERT_EQ(walls.size(), 1U);
  EXPECT_FALSE(walls.front().met);
  EXPECT_FALSE(walls.front().passive);
}

/// Boards and small arms give less than the 3 N with which strong devices meet a wall.
TEST(CertificateTaskTest, AWeakDeviceIsPressedAgainstWallsWithinItsForce) {
  constexpr double kMost = 3.3;  // [N]
  device::SensedMount mount({}, 1);
  device::VirtualDeviceParameters weak;
  weak.max_force = kMost;
  weak.force_delay = 2;
  device::VirtualDevice device(weak, mount, 1000.0);
  const analysis::Excitation excitation(1000.0, 0.4 * kMost);
  CertificateTask task(device, nullptr, excitation, {CertificatePart::kWall},
                       [&mount](CertificatePart, long) { mount.release(); });
  std::size_t tick = 0;
  while (task.tick({tick, static_cast<std::int64_t>(1000000 * tick), 1e-3}) && tick < 400'000) {
    ++tick;
  }
  EXPECT_EQ(task.fault(), device::Fault::kNone) << device::describe(task.fault());
  const std::vector<analysis::WallStep> walls = task.record().walls;
  ASSERT_GE(walls.size(), 2U);
  EXPECT_TRUE(std::ranges::all_of(walls, &analysis::WallStep::met));
  EXPECT_TRUE(walls.front().passive) << "200 N/m";
  EXPECT_FALSE(std::ranges::all_of(walls, &analysis::WallStep::passive));
}

}  // namespace
}  // namespace haptrial::experiments
