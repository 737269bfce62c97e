// The law by which one hand leads another, and what keeps it passive.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/random.h"
#include "core/tutoring/energy_tank.h"
#include "core/tutoring/tutoring_law.h"

namespace haptrial::tutoring::tutoring_test {
namespace {

using Eigen::Vector3d;

constexpr double kDt = 1e-3;

Vector3d any(RandomStream& random, double size) {
  return {random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
}

TEST(TutoringLawTest, PullsTowardsTheInstructorAndPlaysTheForce) {
  const TutoringGains gains{100.0, 3.0, 1.0};
  const Partner instructor{{{0.01, 0.0, 0.0}, {0.0, 0.2, 0.0}}, {0.0, 0.0, 2.0}};
  const PointState trainee{{0.0, 0.0, 0.0}, {0.0, 0.0, 0.1}};
  const Vector3d f = tutoring_force(gains, {}, instructor, trainee, {9.0, 9.0, 9.0});
  EXPECT_NEAR(f.x(), 1.0, 1e-12);
  EXPECT_NEAR(f.y(), 0.6, 1e-12);
  EXPECT_NEAR(f.z(), 2.0 - 0.3, 1e-12);
}

TEST(TutoringLawTest, AuthorityBlendsTheWorldsAndWhoLeadsMayFeelTheOther) {
  const TutoringGains gains{100.0, 0.0, 1.0};
  const Partner partner{{{0.01, 0.0, 0.0}, Vector3d::Zero()}, {0.0, 2.0, 0.0}};
  const Vector3d own(0.0, 0.0, 3.0);
  EXPECT_TRUE(tutoring_force(gains, {0.0, 0.0}, partner, {}, own).isApprox(own));
  EXPECT_TRUE(tutoring_force(gains, {0.0, 0.5}, partner, {}, own).isApprox(Vector3d(0.5, 0, 3)));
  EXPECT_TRUE(
      tutoring_force(gains, {0.25, 0.0}, partner, {}, own).isApprox(Vector3d(0.25, 0.5, 2.25)));
  const PointState lost{{std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0}, Vector3d::Zero()};
  EXPECT_TRUE(tutoring_force(gains, {}, partner, lost, own).isZero(0.0));
}

TEST(TutoringLawTest, AHandoverNeverSteps) {
  Handover handover(2.0);
  handover.ask(1.0);
  double last = 0.0;
  int ticks = 0;
  while (handover.share() < 1.0) {
    const double share = handover.step(kDt);
    ASSERT_LE(share - last, kDt / 2.0 + 1e-12);
    last = share;
    ++ticks;
  }
  EXPECT_NEAR(ticks, 2000, 1);
  handover.ask(std::numeric_limits<double>::quiet_NaN());
  for (int i = 0; i < 3000; ++i) {
    handover.step(kDt);
  }
  EXPECT_EQ(handover.share(), 0.0);
}

TEST(TutoringLawTest, TheBoundOverADelayIsTheOneOfTheLiterature) {
  EXPECT_NEAR(stiffest_over_delay(5.0, 1e-3, 0.02), 243.9, 0.1);
}

/// A hand that is pushed about at random beside a source that wants to push it at random.
TEST(EnergyTankTest, NoForceThatIsAskedForMakesEnergy) {
  RandomStream random(1, "tank");
  EnergyTank tank;
  PointState hand;
  Vector3d force = Vector3d::Zero();
  Vector3d push = Vector3d::Zero();
  Vector3d wanted = Vector3d::Zero();
  double received = 0.0;
  double given = 0.0;
  double worst = 0.0;
  for (int tick = 0; tick < 500'000; ++tick) {
    if (tick % 50 == 0) {
      push = any(random, 3.0);
      wanted = any(random, 10.0);
      received += random.uniform() < 0.3 ? random.uniform(0.0, 0.01) : 0.0;
    }
    const Vector3d was = hand.position;
    hand.velocity += (force + push - 2.0 * hand.velocity) / 0.3 * kDt;
    hand.position += hand.velocity * kDt;
    given += force.dot(hand.position - was);
    const double old = random.uniform();  // of the totals some come late
    force = tank.limit(wanted, hand.position - was, hand.velocity, old < 0.2 ? 0.0 : received, kDt);
    worst = std::max(worst, given + tank.sent() - received);
  }
  EXPECT_LT(worst, 1e-3);
  EXPECT_NEAR(tank.given(), given, 1e-9);
  EXPECT_NEAR(tank.level(), received - given - tank.sent(), 1e-9) << "energy is accounted for";
}

TEST(EnergyTankTest, WithEnoughEnergyNothingIsCut) {
  EnergyTank tank({0.05, 0.0, 100.0, 5.0});
  const Vector3d wanted(1.0, 2.0, 3.0);
  const Vector3d v(0.1, 0.0, 0.0);
  EXPECT_TRUE(tank.limit(wanted, Vector3d::Zero(), v, 10.0, kDt).isApprox(wanted));
  EXPECT_EQ(tank.cut(), 0.0);
}

TEST(EnergyTankTest, WhatIsNotANumberIsNoForce) {
  EnergyTank tank;
  const Vector3d bad = Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_TRUE(tank.limit(bad, Vector3d::Zero(), Vector3d::Zero(), 1.0, kDt).isZero(0.0));
  EXPECT_TRUE(tank.limit(Vector3d::Ones(), bad, Vector3d::Zero(), 1.0, kDt).isZero(0.0));
}

}  // namespace
}  // namespace haptrial::tutoring::tutoring_test
