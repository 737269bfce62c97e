// Shafts that are felt, burrs that wear, and reverse.

#include "core/bone/simulator/handpiece.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/bone/simulator/bone_touch.h"
#include "core/bone/simulator/simulator.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/solid_bone.h"

namespace haptrial::bone::handpiece_test {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
constexpr double kPi = std::numbers::pi;
constexpr double kEdge = 0.25e-3;

/// Bone of x < 0, as tall as it is wide.
BoneModel wall() {
  return test::solid_bone(120, kEdge, [](const Vector3d& p) { return p.x() < 0.0; });
}

BurrTool fissure() {
  BurrTool burr;
  burr.burr =
      default_burr(BurrKind::kCutting, BurrDimensions{BurrForm::kCylinder, 2e-3, 6e-3, 0.0});
  burr.feel = default_feel(BurrShape(burr.burr.dimensions()).ball_radius());
  return burr;
}

SimulatorParameters with(const BurrTool& burr) {
  SimulatorParameters p;
  p.tools = {{"burr", 2.5e-3, 0.1, burr}};
  return p;
}

SimulatorInput upright(const Vector3d& tip, double power = 0.0) {
  SimulatorInput input;
  input.tool.tip.position = tip;
  input.power = power;
  return input;
}

/// The area of a circle's part beyond a chord.
double segment(double radius, double depth) {
  const double below = radius - depth;
  return radius * radius * std::acos(below / radius) -
         below * std::sqrt(radius * radius - below * below);
}

/// The burr is above the bone and its shaft beside a ledge: a wall of 4 mm height meets it.
BoneModel ledge() {
  return test::solid_bone(
      120, kEdge, [](const Vector3d& p) { return p.x() < 0.0 && p.z() > 4e-3 && p.z() < 8e-3; });
}

TEST(HandpieceTest, AShaftIsPushedSidewaysByItsImmersedVolumeAndTakesNothing) {
  BurrTool burr = fissure();
  burr.shaft = default_shaft(0.8e-3, 12e-3);
  Simulator simulator(ledge(), with(burr));
  const std::uint64_t before = simulator.checksum();
  simulator.begin(0);
  simulator.tick(upright({3e-3, 0.0, 0.0}));
  for (const double depth : {0.2e-3, 0.5e-3}) {
    const SimulatorOutput& out = simulator.tick(upright({0.8e-3 - depth, 1e-4, 0.0}, 1.0));
    const double expected = magnitude(4e-3 * segment(0.8e-3, depth), burr.shaft->feel);
    EXPECT_NEAR(out.shaft.x(), expected, 0.05 * expected);
    EXPECT_LT(out.shaft.tail<2>().norm(), 0.02 * expected);
    EXPECT_EQ(out.force.norm(), 0.0) << "the burr is below";
    EXPECT_FALSE(out.contact);
  }
  EXPECT_EQ(simulator.checksum(), before);
}

TEST(HandpieceTest, AShaftIsNotFeltUnlessItIsAskedFor) {
  Simulator simulator(ledge(), with(fissure()));
  simulator.begin(0);
  simulator.tick(upright({3e-3, 0.0, 0.0}));
  EXPECT_EQ(simulator.tick(upright({0.3e-3, 0.0, 0.0})).shaft.norm(), 0.0);
}

TEST(HandpieceTest, AShaftThatIsInBoneAtFirstIsNotFeltBeforeItWasFree) {
  BurrTool burr = fissure();
  burr.shaft = default_shaft(0.8e-3, 12e-3);
  Simulator simulator(ledge(), with(burr));
  simulator.begin(0);
  EXPECT_EQ(simulator.tick(upright({0.3e-3, 0.0, 0.0})).shaft.norm(), 0.0);
  simulator.tick(upright({3e-3, 0.0, 0.0}));
  EXPECT_GT(simulator.tick(upright({0.3e-3, 0.0, 0.0})).shaft.norm(), 0.0);
}

TEST(HandpieceTest, AHandThatIsLedFeelsTheShaftToo) {
  BurrTool burr = fissure();
  burr.shaft = default_shaft(0.8e-3, 12e-3);
  Simulator simulator(ledge(), with(burr));
  simulator.begin(0);
  BoneTouch touch(simulator);
  touch.tick(simulator, upright({3e-3, 0.0, 0.0}).tool);
  simulator.tick(upright({3e-3, 0.0, 0.0}));
  const SimulatorInput pressed = upright({0.4e-3, 0.0, 0.0});
  EXPECT_EQ(touch.tick(simulator, pressed.tool).shaft, simulator.tick(pressed).shaft);
  EXPECT_GT(simulator.output().shaft.x(), 0.5);
}

TEST(HandpieceTest, TheTubeOfTheOtherHandIsFeltBehindItsEnd) {
  for (const double length : {0.0, 12e-3}) {
    SimulatorParameters p = with(fissure());
    p.tube.emplace();
    p.tube->radius = 0.5e-3;
    p.tube->shaft_length = length;
    p.tube->feel = default_feel(p.tube->outer_radius());
    Simulator simulator(ledge(), p);
    simulator.begin(0);
    SimulatorInput input = upright({0.0, 0.0, 0.1});
    input.tube.tool.tip.position = {3e-3, 0.0, 0.0};
    simulator.tick(input);
    input.tube.tool.tip.position.x() = 0.4e-3;
    const TubeOutput& tube = simulator.tick(input).tube;
    EXPECT_EQ(tube.force.norm(), 0.0) << "its end is below";
    if (length > 0.0) {
      const FeelParameters feel = default_shaft(0.7e-3, length).feel;
      const double expected = magnitude(4e-3 * segment(0.7e-3, 0.3e-3), feel);
      EXPECT_NEAR(tube.shaft.x(), expected, 0.05 * expected);
    } else {
      EXPECT_EQ(tube.shaft.norm(), 0.0);
    }
  }
}

/// Presses a burr into a wall for a while. @returns density that each tick took [voxels]
std::vector<double> press(Simulator& simulator, int ticks) {
  simulator.begin(0);
  simulator.tick(upright({5e-3, 0.0, 0.0}));
  std::vector<double> taken;
  for (int n = 0; n < ticks; ++n) {
    const double x = 1e-3 - 5e-6 * n;
    taken.push_back(simulator.tick(upright({x, 0.0, 0.0}, 1.0)).removed);
  }
  return taken;
}

TEST(HandpieceTest, AWornBurrTakesExactlyTheShareOfItsSharpness) {
  constexpr double kWear = 3e-9;
  const BurrTool fresh = fissure();
  BurrTool wearing = fresh;
  wearing.burr.wear_volume = kWear;
  const BoneModel model = wall();
  Simulator simulator(model, with(wearing));
  // The same by hand: a burr that does not wear, turned slower by what the formula says.
  BoneVolume bone(model);
  Drill drill(for_bone(fresh.burr, kEdge), simulator.structures());
  simulator.begin(0);
  simulator.tick(upright({5e-3, 0.0, 0.0}));
  double volume = 0.0;
  for (int n = 0; n < 300; ++n) {
    const Vector3d tip(1e-3 - 5e-6 * n, 0.0, 0.0);
    const double share = kWear / (kWear + volume);
    ASSERT_EQ(simulator.handpiece().sharpness(0), share);
    const SimulatorOutput& out = simulator.tick(upright(tip, 1.0));
    drill.begin_tick();
    const Contact contact = drill.touch(bone, tip, Quaterniond::Identity());
    const double force = bone_force(contact, fresh.feel, fresh.burr, 1.0).norm();
    const Removal removal =
        drill.remove(bone, contact, 0x1p-13 * std::round(force / 0x1p-13), share, 1e-3);
    ASSERT_EQ(out.removed, removal.amount);
    volume += removal.volume;
  }
  EXPECT_GT(volume, 2.0 * kWear) << "it has worn";
  EXPECT_LT(simulator.handpiece().sharpness(0), 0.34);
}

TEST(HandpieceTest, WearFollowsTheLawOverAWholePressing) {
  BurrTool burr = fissure();
  burr.burr.wear_volume = 3e-9;
  Simulator simulator(wall(), with(burr));
  simulator.begin(0);
  simulator.tick(upright({5e-3, 0.0, 0.0}));
  double sharp = 0.0;  // the volume that a burr would have taken that stays as it was
  double volume = 0.0;
  for (int n = 0; n < 300; ++n) {
    const double share = simulator.handpiece().sharpness(0);
    const double taken =
        kEdge * kEdge * kEdge * simulator.tick(upright({1e-3 - 5e-6 * n, 0.0, 0.0}, 1.0)).removed;
    sharp += taken / share;
    volume += taken;
  }
  // dV = W / (W + V) dS, so that V + V^2 / 2 W = S.
  EXPECT_NEAR(volume + volume * volume / (2.0 * 3e-9), sharp, 0.02 * sharp);
}

TEST(HandpieceTest, WithoutWearEveryTickIsTheSame) {
  Simulator plain(wall(), with(fissure()));
  BurrTool hard = fissure();
  hard.burr.wear_volume = 1.0;  // a cubic metre
  Simulator wearing(wall(), with(hard));
  const std::vector<double> one = press(plain, 200);
  const std::vector<double> other = press(wearing, 200);
  double most = 0.0;
  for (std::size_t n = 0; n < one.size(); ++n) {
    EXPECT_NEAR(one[n], other[n], 1e-3 * one[n] + 1e-4);
    most = std::max(most, one[n]);
  }
  EXPECT_GT(most, 1.0);
  EXPECT_EQ(plain.handpiece().sharpness(0), 1.0);
}

TEST(HandpieceTest, ReverseTurnsTheDragRoundAndLeavesThePushAndTheCutting) {
  const auto drag = [](int presses) {
    Simulator simulator(wall(), with(fissure()));
    simulator.begin(0);
    simulator.tick(upright({5e-3, 0.0, 0.0}));
    for (int n = 0; n < presses; ++n) {
      SimulatorInput press = upright({5e-3, 0.0, 0.0});
      press.functions = bit(Function::kReverse);
      simulator.tick(press);
      simulator.tick(press);  // it is held
      simulator.tick(upright({5e-3, 0.0, 0.0}));
    }
    EXPECT_EQ(simulator.handpiece().reversed(), presses % 2 == 1);
    const double before = simulator.shown_turn();
    const SimulatorOutput out = simulator.tick(upright({0.7e-3, 0.0, 0.0}, 1.0));
    EXPECT_GT(out.removed, 0.0);
    double turned = simulator.shown_turn() - before;
    turned -= std::round(turned);
    EXPECT_EQ(turned > 0.0, presses % 2 == 1);
    return out.drag;
  };
  const Vector3d forward = drag(0);
  EXPECT_GT(forward.norm(), 0.05);
  EXPECT_EQ(drag(1), -forward);
  EXPECT_EQ(drag(2), forward);
}

TEST(HandpieceTest, ATickDoesNotAllocate) {
  BurrTool burr = fissure();
  burr.shaft = default_shaft(0.8e-3, 12e-3);
  burr.burr.wear_volume = 1e-8;
  SimulatorParameters p = with(burr);
  p.tube.emplace();
  p.tube->shaft_length = 0.02;
  p.tube->feel = default_feel(p.tube->outer_radius());
  Simulator simulator(wall(), p);
  simulator.begin(0);
  simulator.tick(upright({5e-3, 0.0, 0.0}));
  const test::AllocationGuard guard;
  double shaft = 0.0;
  for (int n = 0; n < 500; ++n) {
    SimulatorInput input = upright({1e-3 - 3e-6 * n, 0.0, 0.0}, 1.0);
    input.functions = n % 100 == 0 ? bit(Function::kReverse) : 0;
    input.tube.tool.tip.position = {1e-3, 3e-3, 0.0};
    shaft += simulator.tick(input).shaft.norm();
  }
  EXPECT_EQ(guard.count(), 0u);
  EXPECT_GT(shaft, 1.0);
}

}  // namespace
}  // namespace haptrial::bone::handpiece_test
