// The law by which one hand leads another, and what keeps it passive.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>

#include "core/base/random.h"
#include "core/control/tutoring/energy_tank.h"
#include "core/control/tutoring/tutoring_law.h"
#include "core/control/tutoring/wave_port.h"

namespace haptrial::control {
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

/// What goes in at both ends less what is under way is 0, whatever the hands do.
TEST(WavePortTest, TheLineLosesNothing) {
  RandomStream random(2, "wave");
  const WaveParameters waves{5.0, 0.0};
  const TutoringGains gains{200.0, 2.0, 1.0};
  WavePort left(waves, gains);
  WavePort right(waves, gains);
  std::deque<Vector3d> there(50, Vector3d::Zero());
  std::deque<Vector3d> back(50, Vector3d::Zero());
  PointState a;
  PointState b;
  double most = 0.0;
  for (int tick = 0; tick < 100'000; ++tick) {
    for (PointState* hand : {&a, &b}) {
      hand->velocity += any(random, 0.05) - 0.02 * hand->velocity - 0.01 * hand->position;
      hand->position += hand->velocity * kDt;
    }
    left.step(back.front(), a, kDt);
    right.step(there.front(), b, kDt);
    back.pop_front();
    there.pop_front();
    there.push_back(left.outgoing());
    back.push_back(right.outgoing());
    double stored = 0.0;
    for (const auto* line : {&there, &back}) {
      for (const Vector3d& wave : *line) {
        stored += 0.5 * wave.squaredNorm() * kDt;
      }
    }
    const double into = left.into_line() + right.into_line();
    most = std::max(most, std::abs(left.into_line()));
    ASSERT_NEAR(into, stored, 1e-12 * static_cast<double>(tick + 1) * std::max(1.0, most));
  }
  EXPECT_GT(most, 1e-3);
}

TEST(WavePortTest, WithoutStrengthAWaveGoesBackAsItCame) {
  WavePort port({5.0, 0.0}, {200.0, 2.0, 1.0});
  const Vector3d wave(0.3, -0.2, 0.1);
  EXPECT_TRUE(port.step(wave, {}, kDt, 0.0).isZero(1e-12));
  EXPECT_TRUE(port.outgoing().isApprox(wave));
}

TEST(WavePortTest, ADriftIsUndoneOnlyWithEnergyThatWasTaken) {
  WavePort port({5.0, 0.5}, {200.0, 2.0, 1.0});
  const Vector3d partner(0.01, 0.0, 0.0);
  port.correct(partner, Vector3d::Zero());
  EXPECT_TRUE(port.reference().position.isZero(0.0)) << "nothing was taken yet";
  const double before = port.budget();
  for (int i = 0; i < 100; ++i) {
    port.step(Vector3d(0.2, 0.0, 0.0), {}, kDt);
  }
  EXPECT_GT(port.budget(), before);
  EXPECT_THROW(WavePort({0.0, 0.5}, {}), std::invalid_argument);
}

}  // namespace
}  // namespace haptrial::control
