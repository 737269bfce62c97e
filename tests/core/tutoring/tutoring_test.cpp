// The law by which one hand leads another, and what keeps it passive.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/random.h"
#include "core/tutoring/deadband.h"
#include "core/tutoring/energy_tank.h"
#include "core/tutoring/held_force.h"
#include "core/tutoring/tutoring_law.h"
#include "tests/support/allocation_guard.h"

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

namespace haptrial::tutoring::deadband_test {
namespace {

// Which ticks of a hand need a message, and what the partner has of those that do not.

using Eigen::Vector3d;

constexpr double kDt = 1e-3;

Vector3d any(RandomStream& random, double size) {
  return {random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
}

/// A hand that draws: sums of a few sines, with a force of contact.
Partner drawn(double t) {
  Partner now;
  now.tool.position = {0.03 * std::sin(1.3 * t), 0.02 * std::sin(2.1 * t),
                       0.01 * std::sin(0.7 * t)};
  now.tool.velocity = {0.039 * std::cos(1.3 * t), 0.042 * std::cos(2.1 * t),
                       0.007 * std::cos(0.7 * t)};
  now.force = {0.0, 2.0 + std::sin(3.0 * t), 0.1 * std::sin(40.0 * t)};
  return now;
}

/// A partner's knowledge at every tick, from the messages and nothing else.
class Hearer {
 public:
  explicit Hearer(const DeadbandParameters& p) : p_(p) {}
  void tick(const Deadband& deadband, bool message) {
    since_ += kDt;
    if (message) {
      heard_ = deadband.sent();
      since_ = 0.0;
    }
  }
  /// Checks that the bounds hold.
  void expect_right(const Partner& now) const {
    const Partner taken = expected(heard_, since_, p_.keepalive);
    ASSERT_LE((taken.force - now.force).norm(),
              std::max(p_.force_fraction * now.force.norm(), p_.least_force));
    ASSERT_LE((taken.tool.position - now.tool.position).norm(), p_.place);
    ASSERT_LT(since_, p_.keepalive);
  }

 private:
  DeadbandParameters p_;
  Partner heard_;
  double since_{0.0};
};

TEST(DeadbandTest, TheErrorStaysWithinTheFractionAtEveryTick) {
  const DeadbandParameters p{0.1, 0.05, 0.0005, 0.05};
  Deadband deadband(p);
  Hearer hearer(p);
  for (int tick = 0; tick < 60'000; ++tick) {
    const Partner now = drawn(kDt * tick);
    hearer.tick(deadband, deadband.due(now, kDt));
    hearer.expect_right(now);
  }
  EXPECT_LT(static_cast<double>(deadband.messages()), 0.15 * static_cast<double>(deadband.ticks()));
}

/// Whatever the forces do: steps, noise, ramps, silence; and messages that go for another reason.
TEST(DeadbandTest, TheErrorStaysWithinTheFractionOfAnyForce) {
  RandomStream random(3, "any force");
  const DeadbandParameters p{0.1, 0.05, 0.0005, 0.05};
  Deadband deadband(p);
  Hearer hearer(p);
  Vector3d level = Vector3d::Zero();
  Vector3d slope = Vector3d::Zero();
  double noise = 0.0;
  for (int tick = 0; tick < 300'000; ++tick) {
    if (tick % 200 == 0) {
      level = any(random, random.uniform(0.0, 1.0) < 0.5 ? 0.1 : 10.0);
      slope = any(random, 20.0);
      noise = std::pow(10.0, random.uniform(-4.0, 0.5));
    }
    level += kDt * slope;
    Partner now = drawn(kDt * tick);
    now.force = level + any(random, noise);
    const bool news = random.uniform(0.0, 1.0) < 0.01;
    const bool message = deadband.due(now, kDt, news);
    ASSERT_TRUE(message || !news);
    hearer.tick(deadband, message);
    hearer.expect_right(now);
  }
}

/// Noise that is nearly as wide as the bound takes few messages, and a ramp no more than with the
/// present force.
TEST(HeldForceTest, AForceInTheMiddleOfWhatComesLastsLonger) {
  RandomStream random(3, "held");
  const double most = 0.2;
  for (const bool ramp : {true, false}) {
    HeldForce forces;
    Vector3d held = Vector3d::Constant(1e3);
    Vector3d plain = held;
    int choices = 0;
    int plainly = 0;
    for (int tick = 0; tick < 20'000; ++tick) {
      const Vector3d force =
          ramp ? Vector3d(0.02 * tick, 0.0, 0.0) : Vector3d(1.0, 0.0, 0.0) + any(random, 0.1);
      forces.add(force);
      if ((force - held).norm() > most) {
        held = forces.choose(most);
        ASSERT_LE((force - held).norm(), most);
        ++choices;
      }
      if ((force - plain).norm() > most) {
        plain = force;
        ++plainly;
      }
    }
    EXPECT_LE(choices, ramp ? plainly : plainly / 2) << plainly;
  }
}

TEST(HeldForceTest, AChoiceDoesNotAllocateAndTakesWhatIsNoNumberAsItIs) {
  HeldForce forces;
  forces.add({1.0, 2.0, 3.0});
  EXPECT_EQ(forces.choose(0.1), Vector3d(1.0, 2.0, 3.0)) << "nothing is known yet";
  const test::AllocationGuard guard;
  for (int i = 0; i < 300; ++i) {
    const double x = i == 150 ? std::numeric_limits<double>::quiet_NaN() : 0.01 * (i % 7);
    forces.add({x, 0.0, 0.0});
    const Vector3d held = forces.choose(0.05);
    ASSERT_EQ(held.allFinite(), i != 150) << i;
  }
  EXPECT_EQ(guard.count(), 0u);
}

TEST(DeadbandTest, AForceIsNeverStuckForLongerThanTheKeepalive) {
  Deadband deadband({0.1, 0.05, 0.0005, 0.05});
  Partner still;
  still.force = {0.0, 1.0, 0.0};
  int since = 0;
  for (int tick = 0; tick < 1000; ++tick) {
    since = deadband.due(still, kDt) ? 0 : since + 1;
    ASSERT_LT(since, 50);
  }
}

}  // namespace
}  // namespace haptrial::tutoring::deadband_test
