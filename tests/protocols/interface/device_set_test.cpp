// A device with torque and grip in the loop: what its wrench is, what stops it, and handles of
// every inertia at their limits.

#include "protocols/interface/device_set.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "tests/support/allocation_guard.h"
#include "tests/support/swings.h"

namespace haptrial::protocols {
namespace {

using device::DeviceReading;
using device::Part;
using device::Wrench;
using Eigen::Vector3d;

constexpr double kTick = 1e-3;     // [s]
constexpr double kRadius = 0.02;   // [m]
constexpr double kTremble = 1e-9;  // so that no reading counts as frozen

/// A handle that turns about y with a moment of inertia and opens and closes a gripper with a mass;
/// its force acts one tick late, and velocities are slopes over eight readings, as those of
/// drivers.
class TurningHandle final : public device::Device {
 public:
  TurningHandle(double inertia, double mass) : inertia_(inertia), mass_(mass) {
    info_.simulated = true;
    info_.torque_axes = Vector3d::Ones();
    info_.max_torque = 1.0;
    info_.max_grip_force = 20.0;
  }
  const device::DeviceInfo& info() const noexcept override { return info_; }
  bool read(DeviceReading& reading) noexcept override {
    DeviceReading now;
    now.tool.position.z() = ++reads_ % 2 == 0 ? kTremble : 0.0;
    now.orientation = Eigen::AngleAxisd(angle_, Vector3d::UnitY());
    now.angular_velocity.y() = slope(angles_);
    now.opening = opening_;
    now.opening_speed = slope(openings_);
    if (on_read) {
      on_read(now);
    }
    reading = now;
    return !fails;
  }
  bool write(const Wrench& wrench) noexcept override {
    constexpr int kSteps = 4;
    for (int i = 0; i < kSteps; ++i) {
      const double h = kTick / kSteps;
      turn_ += h / inertia_ * (late_.torque.y() + hand_torque - hand_damping * turn_);
      angle_ += h * turn_;
      speed_ += h / mass_ * (late_.grip + hand_grip - hand_grip_damping * speed_);
      opening_ += h * speed_;
    }
    late_ = given = wrench;
    angles_[static_cast<std::size_t>(reads_ % 8)] = angle_;
    openings_[static_cast<std::size_t>(reads_ % 8)] = opening_;
    return true;
  }
  void place(double angle, double opening) {
    angle_ = angle;
    opening_ = opening;
    angles_.fill(angle);
    openings_.fill(opening);
  }

  double hand_torque{0.0}, hand_damping{0.0};
  double hand_grip{0.0}, hand_grip_damping{0.0};
  bool fails{false};
  std::function<void(DeviceReading&)> on_read;
  Wrench given;

 private:
  /// The least-squares slope over the last eight readings, from the newest backwards.
  double slope(const std::array<double, 8>& ring) const {
    double sum = 0.0;
    for (int age = 0; age < 8; ++age) {
      sum += (3.5 - age) * ring[static_cast<std::size_t>((reads_ - 1 - age + 80) % 8)];
    }
    return 12.0 / (8.0 * 63.0 * kTick) * sum;
  }

  device::DeviceInfo info_;
  double inertia_, mass_;
  double angle_{0.0}, turn_{0.0}, opening_{0.0}, speed_{0.0};
  std::array<double, 8> angles_{}, openings_{};
  Wrench late_;
  int reads_{0};
};

device::EnvelopeLimits limits(double max_force) {
  device::EnvelopeLimits limits;
  limits.max_force = max_force;
  return limits;
}

/// The three arms of one handle.
DeviceSet set_of(device::Device& handle, double handle_mass = 0.05) {
  return DeviceSet({{&handle, limits(8.0)},
                    {&handle, limits(8.0), Part::kRotation, kRadius, handle_mass},
                    {&handle, limits(8.0), Part::kGrip, 1.0, handle_mass}},
                   {});
}

/// A tick in which laws give the forces at the rotation and the grip.
using Law = std::function<Vector3d(const DeviceReading&)>;
void tick(DeviceSet& set, const Law& rotation, const Law& grip) {
  set.read({}, kTick);
  const Readings readings = set.readings();
  std::array<Drive, 2> others{};
  others[0].force = rotation ? rotation(readings[1]) : Vector3d(Vector3d::Zero());
  others[1].force = grip ? grip(readings[2]) : Vector3d(Vector3d::Zero());
  PassOutput out;
  set.limit(out, others, kTick);
  set.write();
}

TEST(DeviceSetTest, AWrenchHasTheForceOfEachPartInItsPlace) {
  TurningHandle handle(1e-3, 1.0);
  DeviceSet set = set_of(handle);
  for (int i = 0; i < 400; ++i) {
    tick(
        set, [](const auto&) { return Vector3d(0.0, 2.0, 0.0); },
        [](const auto&) { return Vector3d(1.5, 0.0, 0.0); });
  }
  EXPECT_NEAR(handle.given.torque.y(), 2.0 * kRadius, 1e-3 * kRadius);
  EXPECT_NEAR(handle.given.grip, 1.5, 0.1);
  EXPECT_TRUE(handle.given.force.isZero(0.0));
}

TEST(DeviceSetTest, ATurnBeyondTheRangeOfARotationEndsEveryForce) {
  TurningHandle handle(1e-3, 1.0);
  DeviceSet set = set_of(handle);
  handle.hand_torque = 0.05;
  for (int i = 0; i < 3000 && set.fault() == device::Fault::kNone; ++i) {
    tick(set, {}, [](const auto&) { return Vector3d(0.5, 0.0, 0.0); });
  }
  EXPECT_NE(set.fault(), device::Fault::kNone);
  EXPECT_EQ(handle.given.grip, 0.0);
  EXPECT_TRUE(handle.given.torque.isZero(0.0));
}

TEST(DeviceSetTest, AFailedReadEndsEveryForceInTheSameTick) {
  TurningHandle handle(1e-3, 1.0);
  DeviceSet set = set_of(handle);
  const Law push = [](const auto&) { return Vector3d(0.5, 0.0, 0.0); };
  for (int i = 0; i < 300; ++i) {
    tick(set, {}, push);
  }
  ASSERT_GT(handle.given.grip, 0.0);
  handle.fails = true;
  tick(set, {}, push);
  EXPECT_EQ(handle.given.grip, 0.0);
}

TEST(DeviceSetTest, ATickWithPartsDoesNotAllocate) {
  TurningHandle handle(1e-3, 1.0);
  DeviceSet set = set_of(handle);
  const Law push = [](const auto&) { return Vector3d(0.5, 0.0, 0.0); };
  tick(set, push, push);
  const test::AllocationGuard guard;
  for (int i = 0; i < 100; ++i) {
    tick(set, push, push);
  }
  EXPECT_EQ(guard.count(), 0u);
}

/// A part was driven by one law for three seconds, and this came of it.
struct Outcome {
  double train;  // longest of turns [s]
  device::Fault fault;
};

constexpr double kHandle = 0.05;  // of the bare part, at the fingers [kg]

/// @param hand  mass at the fingers; 0: nobody holds it [kg]
Outcome outcome_of(double hand, const Law& law, Part part) {
  const bool turns = part == Part::kRotation;
  const double mass = kHandle + hand;
  TurningHandle handle(mass * kRadius * kRadius, mass);
  handle.place(0.003 / kRadius, 0.003);
  const double damping = 15.0 * hand / 0.8;
  handle.hand_damping = damping * kRadius * kRadius;
  handle.hand_grip_damping = damping;
  DeviceSet set = set_of(handle, kHandle);
  std::vector<double> forces;
  for (int i = 0; i < 3000; ++i) {
    // Once the force has ramped in, fingers press, light ones less.
    const double press = std::min(1.0, 4.0 * hand) * std::clamp(0.005 * (i - 300), 0.0, 1.0);
    (turns ? handle.hand_torque : handle.hand_grip) = press * (turns ? kRadius : 1.0);
    turns ? tick(set, law, {}) : tick(set, {}, law);
    forces.push_back(turns ? handle.given.torque.y() / kRadius : handle.given.grip);
  }
  return {test::longest_train(forces, 1.0 / kTick), set.fault()};
}

struct Firmness {
  const char* name;
  double stiffness, damping;
  bool wall;
};

/// @param gives_way  whether the law uses the shares that the guard leaves it
Law law_of(const Firmness& of, Part part, bool gives_way) {
  const Eigen::Index axis = part == Part::kRotation ? 1 : 0;
  return [of, axis, gives_way](const DeviceReading& reading) {
    const control::GainShares shares = gives_way ? reading.shares : control::GainShares{};
    const double x = reading.tool.position[axis], v = reading.tool.velocity[axis];
    Vector3d force = Vector3d::Zero();
    if (!of.wall || x > 0.0) {
      force[axis] = std::clamp(
          -shares.stiffness * of.stiffness * x - shares.damping * of.damping * v, -8.0, 8.0);
    }
    return force;
  };
}

constexpr Firmness kFirm[] = {{"spring", 1000.0, 10.0, false},
                              {"damper", 0.0, 60.0, false},
                              {"wall", 1500.0, 5.0, true},
                              {"stiff", 2000.0, 30.0, false}};
constexpr double kHands[] = {0.0, 0.02, 0.05, 0.1, 0.3, 0.8};  // [kg]

TEST(DeviceSetTest, NoHandleOfAnyInertiaOscillates) {
  for (const Part part : {Part::kRotation, Part::kGrip}) {
    for (const Firmness& each : kFirm) {
      for (const double hand : kHands) {
        if (each.wall && hand == 0.0) {
          continue;  // it is pushed out, and nothing stops it
        }
        SCOPED_TRACE(testing::Message()
                     << each.name << ", " << device::part_word(part) << ", " << hand << " kg");
        const Outcome outcome = outcome_of(hand, law_of(each, part, true), part);
        EXPECT_LE(outcome.train, 0.2);
        EXPECT_EQ(outcome.fault, device::Fault::kNone) << device::describe(outcome.fault);
      }
    }
  }
}

TEST(DeviceSetTest, WhatDoesNotGiveWayIsEndedAsAnOscillation) {
  for (const Part part : {Part::kRotation, Part::kGrip}) {
    const Outcome outcome = outcome_of(0.0, law_of(kFirm[3], part, false), part);
    EXPECT_EQ(outcome.fault, device::Fault::kOscillation) << device::describe(outcome.fault);
  }
}

}  // namespace
}  // namespace haptrial::protocols
