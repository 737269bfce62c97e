#include "core/bone/simulator/second_hand.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/bone/simulator/companions.h"
#include "core/bone/simulator/simulator.h"
#include "tests/support/allocation_guard.h"

namespace haptrial::bone::second_hand_test {
namespace {

using Eigen::Vector3d;

constexpr double kEdge = 0.4e-3;
constexpr double kTop = 10e-3;  // of the block [m]
const Vector3d kMiddle(10e-3, 10e-3, 0.0);

/// A block of z < kTop, its upper `soft` voxels dura.
BoneModel block(int soft = 0) {
  BoneModel model;
  model.name = "block";
  model.grid = {{50, 50, 40}, {0.5 * kEdge, 0.5 * kEdge, 0.5 * kEdge}, kEdge};
  model.structures = {{}, {"bone", {}}, {"sigmoid sinus and dura", {}, 0.25, true}};
  for (int k = 0; k < 40; ++k) {
    const int depth = 24 - k;  // of the voxel, from the top one, 1
    const std::uint8_t label = depth < 0 ? 0 : depth < soft ? 2 : 1;
    model.labels.insert(model.labels.end(), 50 * 50, label);
  }
  return model;
}

SimulatorParameters with_tube() {
  SimulatorParameters p;
  BurrTool burr;
  burr.burr = default_burr(BurrKind::kCutting, 4e-3);
  burr.feel = default_feel(burr.radius());
  p.tools = {{"burr", 2.5e-3, 0.1, burr}};
  p.tube.emplace();
  p.tube->feel = default_feel(p.tube->outer_radius());
  return p;
}

/// The tube's end at a height above the block, the burr far away.
SimulatorInput at_height(double height) {
  SimulatorInput input;
  input.tool.tip.position = {0.0, 0.0, 0.1};
  input.tube.tool.tip.position = kMiddle + Vector3d(0.0, 0.0, kTop + height);
  return input;
}

/// Volume of a ball's part below a plane at a height under its centre.
double cap(double radius, double height) {
  const double h = radius - height;
  return std::numbers::pi * h * h * (3.0 * radius - h) / 3.0;
}

TEST(SecondHandTest, FlatBonePushesTheTubeOutByTheVolumeOfItsEnd) {
  const SimulatorParameters p = with_tube();
  Simulator simulator(block(), p);
  const std::uint64_t before = simulator.checksum();
  const double radius = p.tube->outer_radius();
  simulator.begin(0);
  simulator.tick(at_height(2.0 * radius));
  for (const double depth : {0.3e-3, 0.6e-3, 1.0e-3}) {
    const TubeOutput tube = simulator.tick(at_height(radius - depth)).tube;
    const double expected = magnitude(cap(radius, radius - depth), p.tube->feel);
    EXPECT_NEAR(tube.force.z(), expected, 0.15 * expected) << depth;
    EXPECT_LT(tube.force.head<2>().norm(), 0.05 * expected) << depth;
    EXPECT_TRUE(tube.contact);
  }
  EXPECT_EQ(simulator.checksum(), before);  // it takes nothing
  EXPECT_EQ(simulator.output().force.norm(), 0.0);
}

TEST(SecondHandTest, ATubeThatIsInBoneAtFirstIsNotFeltBeforeItWasFree) {
  const SimulatorParameters p = with_tube();
  Simulator simulator(block(), p);
  simulator.begin(0);
  EXPECT_EQ(simulator.tick(at_height(0.0)).tube.force.norm(), 0.0);
  EXPECT_TRUE(simulator.output().tube.contact);
  simulator.tick(at_height(5e-3));
  EXPECT_GT(simulator.tick(at_height(0.0)).tube.force.norm(), 0.0);
}

TEST(SecondHandTest, SoftTissueGivesWayStaysAtASuckingTubeAndTears) {
  SimulatorParameters p = with_tube();
  p.soft_tissue = {{"dura", 400.0, 1.0, 0.2}};
  p.bleeding = {{"dura"}, 1e-8};
  Simulator simulator(block(12), p);
  simulator.begin(0);
  const double radius = p.tube->radius;
  const auto go = [&](double height, bool sucks) {
    SimulatorInput input = at_height(height);
    input.tube.sucks = sucks;
    return simulator.tick(input).tube;
  };
  go(radius + 3e-3, false);
  for (int i = 0; i <= 100; ++i) {
    go(radius + 1e-3 - 2e-5 * i, true);
  }
  const TubeOutput pressed = go(radius - 1e-3, true);
  EXPECT_NEAR(pressed.force.z(), 0.4, 0.03);  // k d
  EXPECT_TRUE(pressed.yields);
  const TubeOutput lifted = go(radius + 0.3e-3, true);
  EXPECT_NEAR(lifted.force.z(), -0.12, 0.03);              // it holds
  EXPECT_EQ(go(radius + 0.8e-3, true).force.norm(), 0.0);  // came off at 0.2 N
  EXPECT_TRUE(simulator.soft_tissue().tears().empty());
  bool tore = false;
  for (int i = 0; i < 200 && !tore; ++i) {
    tore = go(radius - 2e-5 * i, false).tore;
  }
  ASSERT_TRUE(tore);
  ASSERT_EQ(simulator.soft_tissue().tears().size(), 1u);
  EXPECT_TRUE(simulator.soft_tissue().tears()[0].by_second);
  EXPECT_NEAR(simulator.soft_tissue().tears()[0].force, 1.0, 0.03);
  EXPECT_FALSE(simulator.emptied().empty());
  EXPECT_EQ(simulator.bleeding().openings(), 1u);
}

/// The burr presses with its side while it turns; water may run.
double hottest(bool rinses, double apart) {
  SimulatorParameters p = with_tube();
  p.heat.emplace();
  p.heat->share = 1.0;
  Simulator simulator(block(), p);
  simulator.begin(0);
  for (int i = 0; i < 3000; ++i) {
    SimulatorInput input;
    const double z = kTop + 2e-3 - (i < 10 ? -5e-3 : 0.3e-3);
    input.tool.tip.position = kMiddle + Vector3d(-4e-3 + 2e-6 * i, 0.0, z);
    input.tool.orientation =
        Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), Vector3d(0.0, 1.0, 0.3));
    input.functions = bit(Function::kPower);
    input.power = 1.0;
    input.tube.tool.tip.position = input.tool.tip.position + Vector3d(0.0, 0.0, apart);
    input.tube.rinses = rinses;
    simulator.tick(input);
  }
  return simulator.heat()->hottest();
}

TEST(SecondHandTest, WaterThatReachesTheBurrCoolsIt) {
  const double body = HeatParameters{}.body;
  const double dry = hottest(false, 5e-3);
  const double rinsed = hottest(true, 5e-3);
  EXPECT_GT(dry - body, 1.0);
  EXPECT_LT(rinsed - body, 0.75 * (dry - body));
  EXPECT_GT(rinsed, body);
  EXPECT_EQ(hottest(true, 7e-3), dry);  // beyond its reach
}

TEST(SecondHandTest, BloodIsSuckedAway) {
  for (const bool sucks : {false, true}) {
    SimulatorParameters p = with_tube();
    p.soft_tissue = {{"dura", 400.0, 0.5, 0.2}};
    p.bleeding = {{"dura"}, 2e-8};
    Simulator simulator(block(12), p);
    CompanionParameters companions;
    companions.dusty = false;
    companions.bleeds = true;
    companions.blood.voxel = kEdge;
    companions.blood.up = Vector3d::UnitZ();
    SteppedCompanions beside(simulator, companions, 1000.0);
    simulator.begin(0);
    const auto tick = [&](double height, bool sucking) {
      SimulatorInput input = at_height(height);
      input.tube.sucks = sucking;
      simulator.tick(input);
      beside.after_tick(simulator, 1e-3);
    };
    tick(5e-3, false);
    for (int i = 0; i < 200; ++i) {
      tick(p.tube->radius - 2e-5 * i, false);
    }
    ASSERT_EQ(simulator.bleeding().openings(), 1u);
    for (int i = 0; i < 3000; ++i) {
      tick(1e-3, sucks);
    }
    const DustBalance blood = beside.blood();
    const double voxel = kEdge * kEdge * kEdge;
    EXPECT_NEAR(voxel * blood.deposited, 2e-8 * 3.1, 0.1 * 2e-8 * 3.1);
    EXPECT_EQ(blood.deposited, blood.lying + blood.held + blood.suctioned + blood.fallen);
    if (sucks) {
      EXPECT_GT(blood.suctioned, 0.6 * blood.deposited);
    } else {
      EXPECT_EQ(blood.suctioned, 0.0);
    }
  }
}

TEST(SecondHandTest, ATickDoesNotAllocate) {
  SimulatorParameters p = with_tube();
  p.heat.emplace();
  p.soft_tissue = {{"dura", 400.0, 0.5, 0.2}};
  p.bleeding = {{"dura"}, 2e-8};
  Simulator simulator(block(12), p);
  simulator.begin(0);
  simulator.tick(at_height(5e-3));
  const test::AllocationGuard guard;
  for (int i = 0; i < 2000; ++i) {
    SimulatorInput input = at_height(2e-3 - 3e-6 * i);
    input.tube.sucks = i % 2 == 0;
    input.tube.rinses = true;
    input.tool.tip.position = kMiddle + Vector3d(4e-3, 0.0, kTop + 2e-3 - 2e-6 * i);
    input.power = 1.0;
    simulator.tick(input);
  }
  EXPECT_EQ(guard.count(), 0u);
  EXPECT_GT(simulator.bleeding().openings(), 0u);
}

}  // namespace
}  // namespace haptrial::bone::second_hand_test
