// A device with torque and grip in the loop: what its wrench is, what stops it, and handles of
// every inertia at their limits.

#include "protocols/interface/device_set.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>

#include "tests/protocols/interface/turning_handle.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/swings.h"

namespace haptrial::protocols {
namespace {

using device::DeviceReading;
using device::Part;
using device::Wrench;
using Eigen::Vector3d;

using test::kFingers;
using test::TurningHandle;

constexpr double kTick = 1e-3;  // [s]

device::EnvelopeLimits limits(double max_force) {
  device::EnvelopeLimits limits;
  limits.max_force = max_force;
  return limits;
}

/// The three arms of one handle.
DeviceSet set_of(device::Device& handle, double handle_mass = 0.05) {
  return DeviceSet({{&handle, limits(8.0)},
                    {&handle, limits(8.0), Part::kRotation, kFingers, handle_mass},
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
  TurningHandle handle(1e-3 / (kFingers * kFingers), 1.0);
  DeviceSet set = set_of(handle);
  for (int i = 0; i < 400; ++i) {
    tick(
        set, [](const auto&) { return Vector3d(0.0, 2.0, 0.0); },
        [](const auto&) { return Vector3d(1.5, 0.0, 0.0); });
  }
  EXPECT_NEAR(handle.given.torque.y(), 2.0 * kFingers, 1e-3 * kFingers);
  EXPECT_NEAR(handle.given.grip, 1.5, 0.1);
  EXPECT_TRUE(handle.given.force.isZero(0.0));
}

TEST(DeviceSetTest, ATurnBeyondTheRangeOfARotationEndsEveryForce) {
  TurningHandle handle(1e-3 / (kFingers * kFingers), 1.0);
  DeviceSet set = set_of(handle);
  handle.hand_at_rotation = 0.05 / kFingers;
  for (int i = 0; i < 3000 && set.fault() == device::Fault::kNone; ++i) {
    tick(set, {}, [](const auto&) { return Vector3d(0.5, 0.0, 0.0); });
  }
  EXPECT_NE(set.fault(), device::Fault::kNone);
  EXPECT_EQ(handle.given.grip, 0.0);
  EXPECT_TRUE(handle.given.torque.isZero(0.0));
}

TEST(DeviceSetTest, AFailedReadEndsEveryForceInTheSameTick) {
  TurningHandle handle(1e-3 / (kFingers * kFingers), 1.0);
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

TEST(DeviceSetTest, ARotationGoesOnAfterAnOrientationThatIsNoNumber) {
  TurningHandle handle(1e-3 / (kFingers * kFingers), 1.0);
  DeviceSet set = set_of(handle);
  const Law push = [](const auto&) { return Vector3d(0.0, 0.1, 0.0); };
  for (int i = 0; i < 300; ++i) {
    tick(set, push, {});
  }
  handle.on_read = [](DeviceReading& reading) {
    reading.orientation.coeffs().setConstant(std::numeric_limits<double>::quiet_NaN());
  };
  tick(set, push, {});
  EXPECT_EQ(set.fault(), device::Fault::kOrientationNotFinite);
  EXPECT_TRUE(handle.given.torque.isZero(0.0));
  handle.on_read = nullptr;
  tick(set, push, {});
  set.reset();
  set.engage();
  for (int i = 0; i < 400; ++i) {
    tick(set, push, {});
  }
  EXPECT_EQ(set.fault(), device::Fault::kNone);
  EXPECT_NEAR(handle.given.torque.y(), 0.1 * kFingers, 1e-3 * kFingers);
}

TEST(DeviceSetTest, ATickWithPartsDoesNotAllocate) {
  TurningHandle handle(1e-3 / (kFingers * kFingers), 1.0);
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
struct SetOutcome {
  double train;  // longest of turns [s]
  device::Fault fault;
};

constexpr double kHandle = 0.05;  // of the bare part, at the fingers [kg]

/// @param hand  mass at the fingers; 0: nobody holds it [kg]
SetOutcome outcome_of(double hand, const Law& law, Part part) {
  const bool turns = part == Part::kRotation;
  const double mass = kHandle + hand;
  TurningHandle handle(mass, mass);
  handle.place(0.003);
  const double damping = 15.0 * hand / 0.8;
  handle.hand = {0.0, damping, 0.0};
  DeviceSet set = set_of(handle, kHandle);
  std::vector<double> forces;
  for (int i = 0; i < 3000; ++i) {
    // Once the force has ramped in, fingers press, light ones less.
    const double press = std::min(1.0, 4.0 * hand) * std::clamp(0.005 * (i - 300), 0.0, 1.0);
    (turns ? handle.hand_at_rotation : handle.hand_at_grip) = press;
    turns ? tick(set, law, {}) : tick(set, {}, law);
    forces.push_back(turns ? handle.given.torque.y() / kFingers : handle.given.grip);
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
        const SetOutcome outcome = outcome_of(hand, law_of(each, part, true), part);
        EXPECT_LE(outcome.train, 0.2);
        EXPECT_EQ(outcome.fault, device::Fault::kNone) << device::describe(outcome.fault);
      }
    }
  }
}

TEST(DeviceSetTest, WhatDoesNotGiveWayIsEndedAsAnOscillation) {
  for (const Part part : {Part::kRotation, Part::kGrip}) {
    const SetOutcome outcome = outcome_of(0.0, law_of(kFirm[3], part, false), part);
    EXPECT_EQ(outcome.fault, device::Fault::kOscillation) << device::describe(outcome.fault);
  }
}

/// The greatest force at the grip of a bare handle on a spring that makes it oscillate.
/// @param most  limit of the protocol's own; the spring gives 1 N at most [N]
double greatest_at_grip(double most) {
  TurningHandle handle(kHandle, kHandle);
  handle.place(0.003);
  DeviceSet set = set_of(handle, kHandle);
  const Law law = law_of(kFirm[3], Part::kGrip, false);
  double greatest = 0.0;
  for (int i = 0; i < 1500; ++i) {
    set.read({}, kTick);
    std::array<Drive, 2> others{};
    others[1].force = law(set.readings()[2]).cwiseMax(-1.0).cwiseMin(1.0);
    others[1].most = most;
    set.limit(PassOutput{}, others, kTick);
    set.write();
    greatest = std::max(greatest, std::abs(handle.given.grip));
  }
  return greatest;
}

TEST(DeviceSetTest, TheDamperThatCalmsAHandleComesWithinTheProtocolsLimit) {
  EXPECT_GT(greatest_at_grip(std::numeric_limits<double>::infinity()), 1.01);
  EXPECT_LE(greatest_at_grip(1.0), 1.0 + 1e-9);
}

}  // namespace
}  // namespace haptrial::protocols
