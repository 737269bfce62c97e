#include "core/subject/hand.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/random.h"
#include "core/subject/hand_cvode.h"
#include "tests/support/allocation_guard.h"

namespace haptrial::subject::hand_test {
namespace {

constexpr double kStep = 1e-3;
const Eigen::Vector3d kOrigin = Eigen::Vector3d::Zero();

HandParameters frictionless() {
  HandParameters p;
  p.coulomb_friction = 0.0;
  return p;
}

/// A force and command that change every tick, as a session's do.
struct Drive {
  RandomStream random{7, "drive"};
  Eigen::Vector3d force{Eigen::Vector3d::Zero()};
  HandCommand command;
  void next(int tick) {
    const double t = tick * kStep;
    force = {3.0 * std::sin(7.0 * t), 8.0 * std::sin(2.0 * t), random.uniform(-2.0, 2.0)};
    command.press = 5.0 + 5.0 * std::sin(3.0 * t);
    command.holds_posture = (tick / 500) % 2 == 1;
    command.force = {0.0, random.uniform(-0.1, 0.1), 0.0};
  }
};

TEST(HandTest, LinearPartAgreesWithCvodeTo1em6) {
  Hand exact(frictionless(), kStep, kOrigin);
  CvodeHand reference(frictionless(), 1e-3, 1e-11, kOrigin);
  Drive drive;
  double largest = 0.0;
  for (int tick = 0; tick < 3000; ++tick) {
    drive.next(tick);
    exact.command(drive.command);
    reference.command(drive.command);
    const PointState a = exact.step(drive.force, kStep);
    const PointState b = reference.step(drive.force, kStep);
    largest = std::max(largest, (a.position - b.position).norm());
    largest = std::max(largest, (a.velocity - b.velocity).norm());
  }
  ASSERT_TRUE(reference.ok());
  RecordProperty("largest_difference", std::to_string(largest));
  EXPECT_LT(largest, 1e-6);
}

TEST(HandTest, FrictionAgreesWithTheSmoothLawWhereTheHandMoves) {
  HandParameters p;
  p.coulomb_friction = 0.5;
  Hand exact(p, kStep, kOrigin);
  CvodeHand reference(p, 1e-4, 1e-9, kOrigin);
  double largest = 0.0;
  double reach = 0.0;
  for (int tick = 0; tick < 2000; ++tick) {
    const Eigen::Vector3d force(4.0 * std::sin(6.0 * tick * kStep), 0.0, 0.0);
    const PointState a = exact.step(force, kStep);
    const PointState b = reference.step(force, kStep);
    largest = std::max(largest, (a.position - b.position).norm());
    reach = std::max(reach, a.position.norm());
  }
  ASSERT_TRUE(reference.ok());
  EXPECT_GT(reach, 0.01);
  EXPECT_LT(largest, 0.01 * reach);  // the laws differ below the slip speed only
}

TEST(HandTest, FrictionHoldsAgainstLessThanItself) {
  HandParameters p;
  p.coulomb_friction = 0.5;
  Hand hand(p, kStep, kOrigin);
  for (int tick = 0; tick < 1000; ++tick) {
    hand.step({0.49, 0.0, -0.49}, kStep);
  }
  EXPECT_LT(hand.state().position.norm(), 1e-12);
  for (int tick = 0; tick < 1000; ++tick) {
    hand.step({0.6, 0.0, 0.0}, kStep);
  }
  EXPECT_GT(hand.state().position.x(), 1e-4);
}

TEST(HandTest, FrictionNeverAddsEnergy) {
  HandParameters p;
  p.stiffness = 0.0;
  p.damping = 0.0;
  p.coulomb_friction = 0.3;
  Hand hand(p, kStep, kOrigin);
  for (int tick = 0; tick < 100; ++tick) {
    hand.step({5.0, 0.0, 0.0}, kStep);
  }
  double speed = hand.state().velocity.norm();
  const double expected_loss = 0.3 / (p.handle_mass + p.hand_mass) * kStep;
  while (speed > 2.0 * expected_loss) {
    const double next = hand.step(kOrigin, kStep).velocity.norm();
    EXPECT_NEAR(speed - next, expected_loss, 1e-12);
    speed = next;
  }
  hand.step(kOrigin, kStep);
  hand.step(kOrigin, kStep);
  EXPECT_LT(hand.state().velocity.norm(), 1e-12);
}

TEST(HandTest, HeldPostureIsASpringOfItsStiffness) {
  const HandParameters p = frictionless();
  Hand hand(p, kStep, kOrigin);
  HandCommand hold;
  hold.holds_posture = true;
  hand.command(hold);
  for (int tick = 0; tick < 5000; ++tick) {
    hand.step({0.0, 5.0, 0.0}, kStep);
  }
  EXPECT_NEAR(hand.state().position.y(), 5.0 / p.stiffness, 1e-9);
}

TEST(HandTest, YieldingPostureDragsAtItsStiffnessTimesTime) {
  // At constant speed v a spring in series with a yielding posture pulls back with k · tau · v.
  const HandParameters p = frictionless();
  Hand hand(p, kStep, kOrigin);
  const double force = 2.0;
  for (int tick = 0; tick < 5000; ++tick) {
    hand.step({force, 0.0, 0.0}, kStep);
  }
  const double drag = p.damping + p.stiffness * p.posture_time;
  EXPECT_NEAR(hand.state().velocity.x(), force / drag, 1e-6);
}

TEST(HandTest, MuscleReachesTheCommandAfterItsLags) {
  // Against a stiff wall of posture, position shows the muscle force; 63 % of a step come late.
  HandParameters p = frictionless();
  p.stiffness = 5000.0;
  p.damping = 200.0;
  Hand hand(p, kStep, kOrigin);
  HandCommand press;
  press.press = 6.0;
  press.holds_posture = true;
  hand.command(press);
  double lag = 0.0;  // area over the step response: the sum of all first-order lags
  for (int tick = 0; tick < 4000; ++tick) {
    const double share = -hand.step(kOrigin, kStep).position.y() * p.stiffness / press.press;
    lag += (1.0 - share) * kStep;
  }
  EXPECT_NEAR(-hand.state().position.y(), press.press / p.stiffness, 1e-9);
  EXPECT_NEAR(lag, p.excitation_time + p.activation_time + p.damping / p.stiffness, 1e-3);
}

TEST(HandTest, StepDoesNotAllocate) {
  Hand hand(HandParameters{}, kStep, kOrigin);
  const test::AllocationGuard guard;
  for (int tick = 0; tick < 100; ++tick) {
    hand.command({1.0, tick % 2 == 0, kOrigin});
    hand.step({1.0, 2.0, 3.0}, kStep);
  }
  EXPECT_EQ(guard.count(), 0u);
}

}  // namespace
}  // namespace haptrial::subject::hand_test
