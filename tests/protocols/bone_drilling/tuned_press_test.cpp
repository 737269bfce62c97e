// A hand presses a burr on bone through the envelope while the feel of the bone is tuned.

#include <gtest/gtest.h>

#include <algorithm>

#include "core/bone/simulator/simulator.h"
#include "core/device/envelope.h"
#include "tests/support/pressing_hand.h"
#include "tests/support/solid_bone.h"

namespace haptrial::protocols::tuned_press_test {
namespace {

using Eigen::Vector3d;
using test::PressingHand;
constexpr double kDt = 1e-3;
constexpr double kRadius = 2e-3;

/// @param stiffer  gains over the default ones
bone::SimulatorParameters with_gains(double stiffer) {
  bone::BurrTool tool;
  tool.burr = bone::default_burr(bone::BurrKind::kCutting, 2.0 * kRadius);
  tool.feel = bone::default_feel(kRadius);
  tool.feel.first_gain *= stiffer;
  tool.feel.second_gain *= stiffer;
  bone::SimulatorParameters p;
  p.tools = {{"burr", 2.5e-3, 0.1, tool}};
  return p;
}

/// The contact of a burr at rest that stands upright.
Vector3d force_at(bone::Simulator& simulator, const Vector3d& tip) {
  bone::SimulatorInput input;
  input.tool.tip.position = tip;
  input.dt = kDt;
  return simulator.tick(input).force;
}

/// A hand that presses while its bone becomes another, through the envelope as a session has it.
struct Pressed {
  double greatest_step{0.0};  // of the force between two ticks, once the hand is at rest [N]
  double force{0.0};          // at the end [N]
  device::Fault fault{device::Fault::kNone};
};
Pressed press_through_a_change(double newtons, double stiffer) {
  bone::Simulator simulator(test::flat_bone(48, 0.5e-3), with_gains(1.0));
  simulator.begin(0);
  force_at(simulator, {0.0, 0.0, 3.0 * kRadius});  // it has been free
  device::EnvelopeLimits limits;
  limits.ramp_in = 0.05;
  device::Envelope envelope(limits);
  PressingHand hand({0.0, 0.0, kRadius}, {.press = newtons});
  Vector3d force = Vector3d::Zero();
  Pressed out;
  for (int tick = 0; tick < 6000; ++tick) {
    if (tick == 3000) {
      simulator.tune(bone::tuning_of(with_gains(stiffer)));
    }
    device::DeviceReading reading;
    reading.tool = {hand.position(), hand.velocity()};
    out.fault = envelope.check(true, reading);
    const Vector3d now = envelope.limit(force_at(simulator, hand.position()), kDt);
    out.greatest_step = std::max(out.greatest_step, tick < 2900 ? 0.0 : (now - force).norm());
    force = now;
    hand.step(force, kDt);
  }
  out.force = force.z();
  return out;
}

TEST(TunedPressTest, AChangeUnderAPressingHandStepsNoForce) {
  for (const double newtons : {0.5, 3.0, 8.0}) {
    for (const double stiffer : {0.2, 3.0}) {
      const Pressed pressed = press_through_a_change(newtons, stiffer);
      const double limit = bone::default_feel(kRadius).force_limit;
      // Beside the transition the hand moves, whose force follows it.
      EXPECT_LT(pressed.greatest_step, 2.0 * limit * kDt / bone::ForceTransition::kTime + 0.05)
          << newtons << ' ' << stiffer;
      EXPECT_LT(pressed.greatest_step, device::EnvelopeLimits{}.max_force_rate * kDt);
      EXPECT_NEAR(pressed.force, newtons, 0.15) << "the hand is at rest again";
      EXPECT_EQ(pressed.fault, device::Fault::kNone);
    }
  }
}

}  // namespace
}  // namespace haptrial::protocols::tuned_press_test
