#include "core/deformable/touch/moving_touch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "core/base/error.h"
#include "core/base/random.h"
#include "core/deformable/springs/equilibrium.h"
#include "tests/core/deformable/touch/soft_block.h"
#include "tests/support/allocation_guard.h"

namespace haptrial::deformable::moving_touch_test {
namespace {

using Eigen::Vector3d;

constexpr double kTop = 0.012;  // of the soft block [m]
constexpr double kTick = 0.001;
constexpr double kRadius = 0.006;

SpringTissue soft_springs(double decay = 25.0) {
  const double cell = 0.048 / 12;
  const double energy = 15e3 * cell * cell * cell;
  return {{0.5 * energy, 0.2 * energy, energy}, nullptr, 1000.0, decay};
}

SharedMovingBody soft_body(double decay = 25.0) {
  return prepared(test::soft_block(12), soft_springs(decay));
}

/// The same block, and nothing holds it.
SharedMovingBody free_body() {
  HapticMesh mesh = *test::soft_block(6);
  std::ranges::fill(mesh.held, std::uint8_t{0});
  return prepared(std::make_shared<const HapticMesh>(std::move(mesh)), soft_springs(0.0));
}

TouchOptions ball(double radius = kRadius, double friction = 0.0) {
  return {radius, 5000.0, {friction, 0.8 * friction}};
}

Vector3d sum_of(std::span<const VertexForce> forces) {
  Vector3d sum = Vector3d::Zero();
  for (const VertexForce& each : forces) {
    sum += each.force.cast<double>();
  }
  return sum;
}

/// Goes down at a speed, then stays. @returns the last contact
contact::Contact press(MovingTouch& touch, const Vector3d& over, double depth, double speed,
                       int stay) {
  touch.start(over + Vector3d(0.0, 0.0005, 0.0));
  const int ticks = static_cast<int>((depth + 0.0005) / (speed * kTick));
  contact::Contact last;
  for (int i = 1; i <= ticks + stay; ++i) {
    const double down = (depth + 0.0005) * std::min(i, ticks) / ticks - 0.0005;
    last = touch.tick(over - Vector3d(0.0, down, 0.0), kTick);
  }
  return last;
}

struct Difference {
  double largest{};  // of a vertex from its place at rest under the same forces [m]
  double moved{};    // of a vertex there [m]
};

/// How far the body is from where Newton's method on its energy finds it at rest.
Difference from_equilibrium(const MovingBody& body, const MovingTouch& touch) {
  LoadCase load{"touch", {}, {}};
  for (const std::int32_t v : body.held) {
    load.holds.push_back({v, Vector3d::Zero()});
  }
  for (const VertexForce& each : touch.forces()) {
    load.forces.push_back({each.vertex, each.force.cast<double>()});
  }
  const Equilibrium rest = equilibrium(body.springs, load);
  EXPECT_EQ(rest.outcome, Settling::kSettled);
  Difference difference;
  for (std::size_t v = 0; v < rest.positions.size(); ++v) {
    difference.largest =
        std::max(difference.largest, (rest.positions[v] - touch.motion().position(v)).norm());
    difference.moved =
        std::max(difference.moved, (rest.positions[v] - body.springs.rest[v]).norm());
  }
  return difference;
}

TEST(MovingTouchTest, HeldStillItIsTheEquilibriumOfItsSpringsOnTheBall) {
  for (const double friction : {0.0, 0.3}) {
    MovingTouch touch(soft_body(), ball(kRadius, friction), kTick);
    const Vector3d over(0.0013, kTop + kRadius, 0.0007);
    const contact::Contact felt = press(touch, over, 0.0015, 0.01, 600);
    const Difference difference = from_equilibrium(*soft_body(), touch);
    EXPECT_GT(difference.moved, 0.001);
    EXPECT_LT(difference.largest, 1e-5 * difference.moved) << friction;
    EXPECT_GT(felt.force.y(), 0.1);
    // The surface lies on the ball, whose centre the spring holds.
    EXPECT_NEAR((felt.proxy - (over - Vector3d(0, 0.0015, 0) + felt.force / 5000.0)).norm(), 0.0,
                1e-8);
    double least = 1.0;
    for (const Face& face : soft_body()->mesh->felt) {
      for (const std::int32_t v : face) {
        const Vector3d p = touch.motion().position(static_cast<std::size_t>(v));
        least = std::min(least, (p - felt.proxy).norm() - kRadius);
      }
    }
    EXPECT_GT(least, -1e-6);
  }
}

/// A hand that presses slowly feels the stiffness of the statics all the way.
TEST(MovingTouchTest, PressedSlowlyItFeelsItsStatics) {
  const Vector3d over(0.0013, kTop + kRadius, 0.0007);
  for (const double depth : {0.0005, 0.001, 0.002}) {
    MovingTouch slow(soft_body(), ball(), kTick);
    MovingTouch held(soft_body(), ball(), kTick);
    const double now = press(slow, over, depth, 0.002, 0).force.norm();
    const double rest = press(held, over, depth, 0.01, 600).force.norm();
    EXPECT_NEAR(now / rest, 1.0, 0.02) << depth;
    const Difference difference = from_equilibrium(*soft_body(), slow);
    EXPECT_LT(difference.largest, 0.03 * difference.moved) << depth;
  }
}

TEST(MovingTouchTest, WhatIsFeltIsWhatTheBodyGets) {
  MovingTouch touch(soft_body(), ball(kRadius, 0.4), kTick);
  Vector3d hand(0.001, kTop + kRadius, -0.002);
  touch.start(hand);
  for (int i = 0; i < 600; ++i) {
    hand += Vector3d(i < 300 ? 0.0 : 2e-5, i < 300 ? -1e-5 : 0.0, i < 450 ? 0.0 : -1e-5);
    const contact::Contact& felt = touch.tick(hand, kTick);
    EXPECT_LT((felt.force + sum_of(touch.forces())).norm(), 1e-6 * felt.force.norm() + 1e-12) << i;
  }
  EXPECT_GT(touch.counts().contact, 550u);
  EXPECT_EQ(touch.counts().limited, 0u);
  EXPECT_EQ(touch.counts().inverted, 0u);
  EXPECT_EQ(touch.counts().flown_apart, 0u);
}

/// Newton: a body that nothing holds has the momentum and the angular momentum that the ball gave.
TEST(MovingTouchTest, AFreeBodyGetsTheMomentumOfTheBallsForces) {
  const SharedMovingBody body = free_body();
  MovingTouch touch(body, ball(kRadius, 0.3), kTick);
  Vector3d hand(0.004, kTop + kRadius + 0.0005, 0.003);
  touch.start(hand);
  Vector3d given = Vector3d::Zero();
  for (int i = 0; i < 100; ++i) {
    hand += Vector3d(1e-5, -1e-4, 0.0);
    given -= kTick * touch.tick(hand, kTick).force;
  }
  ASSERT_GT(given.norm(), 1e-3);
  EXPECT_LT((touch.motion().momentum() - given).norm(), 1e-9 * given.norm());
  EXPECT_EQ(touch.counts().limited, 0u) << "what was felt is what was given";
}

/// The work of the hand is at least what the body has in motion and in its springs.
TEST(MovingTouchTest, TheBodyHasNoMoreEnergyThanTheHandGave) {
  for (const double speed : {0.01, 0.05, 0.2}) {
    MovingTouch touch(soft_body(0.0), ball(kRadius, 0.3), kTick);
    const Vector3d over(0.0, kTop + kRadius, 0.0);
    touch.start(over);
    double work = 0.0;
    Vector3d hand = over;
    const int ticks = static_cast<int>(0.003 / (speed * kTick));
    for (int i = 0; i < ticks; ++i) {
      const Vector3d way(0.0, -speed * kTick, 0.0);
      hand += way;
      work -= touch.tick(hand, kTick).force.dot(way);  // of the force over this tick's way
    }
    std::vector<Vector3d> at = touch.motion().positions();
    const double stored = spring_energy(soft_body(0.0)->springs, at);
    double moving = 0.0;
    for (std::size_t v = 0; v < at.size(); ++v) {
      moving += 0.5 * soft_body(0.0)->springs.masses[v] * touch.motion().velocity(v).squaredNorm();
    }
    const double spring = 0.5 * touch.tick(hand, kTick).force.squaredNorm() / 5000.0;
    ASSERT_GT(work, 1e-5);
    EXPECT_LT(stored + moving + spring, 1.002 * work) << speed;
    EXPECT_GT(stored + moving + spring, 0.95 * work) << speed;
  }
}

/// Closed paths of a hand, smooth and shaking, with the force held over each tick.
TEST(MovingTouchTest, AClosedPathGivesNoEnergy) {
  for (const double shake : {0.0, 1e-4, 5e-4}) {
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      MovingTouch touch(soft_body(), ball(kRadius, seed % 2 == 0 ? 0.4 : 0.0), kTick);
      RandomStream random(seed, "path");
      const Vector3d start(0.0, kTop + kRadius + 0.0005, 0.0);
      constexpr int kTicks = 1000;
      touch.start(start);
      double given = 0.0, taken = 0.0;  // by the force; by the damping of the hand
      std::uint64_t contacts = 0;
      Vector3d held = Vector3d::Zero(), before = start;
      for (int i = 1; i <= kTicks; ++i) {
        const double t = 2.0 * std::numbers::pi * i / kTicks;
        const double down = 0.5 - 0.5 * std::cos(t);
        const Vector3d noise(random.normal(), random.normal(), random.normal());
        const Vector3d at = start +
                            Vector3d(0.004 * std::sin(3.0 * t) * down,
                                     -0.003 * down * (1.0 + 0.3 * std::sin(7.0 * t)), 0.0) +
                            (i < kTicks ? shake : 0.0) * noise;
        given += held.dot(at - before);
        taken += EnergyAccount::kDamping * (at - before).squaredNorm() / kTick;
        const bool free = held.isZero(0.0);
        held = touch.tick(at, kTick).force;
        contacts += free && !held.isZero(0.0) ? 1 : 0;
        before = at;
      }
      const double loans = EnergyAccount::kLoan * static_cast<double>(contacts);
      EXPECT_LT(given, taken + loans) << shake << " " << seed;
      if (shake == 0.0) {
        EXPECT_EQ(touch.counts().limited, 0u) << "a smooth hand feels it whole " << seed;
      }
      EXPECT_EQ(touch.counts().flown_apart, 0u);
    }
  }
}

/// A hand that shakes on a stiff surface at half the loop's rate would be driven by a force that is
/// held: what it is given in a second, beyond what its damping takes, is at most the loans.
TEST(MovingTouchTest, AShakingHandIsNotDriven) {
  SpringTissue stiff = soft_springs();
  stiff.density = 4000.0;
  for (double* constant :
       {&stiff.constants.length, &stiff.constants.area, &stiff.constants.volume}) {
    *constant *= 100.0;
  }
  MovingTouch touch(prepared(test::soft_block(12), stiff), {kRadius, 5e4, {}}, kTick);
  const Vector3d over(0.0, kTop + kRadius - 0.0003, 0.0);
  touch.start(over + Vector3d(0.0, 0.002, 0.0));
  double given = 0.0, taken = 0.0;
  Vector3d held = Vector3d::Zero(), before = over + Vector3d(0.0, 0.002, 0.0);
  for (int i = 0; i < 1000; ++i) {
    const Vector3d at = over + Vector3d(0.0, i % 2 == 0 ? 1.5e-4 : -1.5e-4, 0.0);
    given += held.dot(at - before);
    taken += EnergyAccount::kDamping * (at - before).squaredNorm() / kTick;
    held = touch.tick(at, kTick).force;
    before = at;
  }
  EXPECT_GT(touch.counts().limited, 0u) << "without its account it would be driven";
  EXPECT_LT(given, taken + 3.0 * EnergyAccount::kLoan);
}

/// A hand that holds a side and pulls feels what Newton's method finds with that side moved.
TEST(MovingTouchTest, AGraspedSideIsFeltAsItsStatics) {
  FeltSides sides;
  sides.fixed = {BodySide::kLeft};
  sides.grasped = {BodySide::kRight};
  const auto mesh =
      std::make_shared<const HapticMesh>(felt_block({0.048, 0.024, 0.024}, 12, sides, "bar"));
  const SharedMovingBody body = prepared(mesh, soft_springs(50.0));
  MovingTouch touch(body, ball(), kTick);
  const Vector3d begin(0.1, -0.05, 0.02), way(0.006, 0.002, 0.0);
  touch.start(begin);
  contact::Contact felt;
  for (int i = 1; i <= 1200; ++i) {
    felt = touch.tick(begin + std::min(1.0, i / 500.0) * way, kTick);
  }
  LoadCase load{"pull", {}, {}};
  for (const std::int32_t v : body->held) {
    load.holds.push_back({v, Vector3d::Zero()});
  }
  for (const std::int32_t v : mesh->grasped) {
    std::ranges::find(load.holds, v, &Hold::vertex)->displacement = way;
  }
  const Equilibrium rest = equilibrium(body->springs, load);
  ASSERT_EQ(rest.outcome, Settling::kSettled);
  const std::vector<Vector3d> forces = spring_forces(body->springs, rest.positions);
  Vector3d expected = Vector3d::Zero();
  for (const std::int32_t v : mesh->grasped) {
    expected += forces[static_cast<std::size_t>(v)];
  }
  ASSERT_GT(expected.norm(), 0.1);
  EXPECT_LT((felt.force - expected).norm(), 1e-4 * expected.norm());
  EXPECT_LT((felt.force + sum_of(touch.forces())).norm(), 1e-6 * expected.norm());
  EXPECT_EQ(touch.counts().limited, 0u);
  EXPECT_GT(felt.force.dot(-way), 0.0) << "it pulls back";
}

TEST(MovingTouchTest, FrictionHoldsUpToItsBoundAndThenSlips) {
  const double mu = 0.4;
  MovingTouch touch(soft_body(), ball(kRadius, mu), kTick);
  const Vector3d down(0.0, kTop + kRadius, 0.0);
  press(touch, down, 0.001, 0.01, 300);
  bool stuck = false;
  for (int i = 1; i <= 4000; ++i) {
    const contact::Contact& felt = touch.tick(down + Vector3d(2e-6 * i, -0.001, 0.0), kTick);
    const double normal = felt.force.dot(felt.normal);
    const double across = (felt.force - normal * felt.normal).norm();
    ASSERT_LT(across, mu * normal * 1.05) << i;
    if (felt.state == contact::ContactState::kStick) {
      stuck = stuck || i > 100;
    } else if (stuck) {
      // The mean of a tick on which it began to slip.
      EXPECT_GT(across / normal, 0.78 * mu);
      EXPECT_LT(across / normal, 1.03 * mu);
      return;
    }
  }
  FAIL() << "never slipped";
}

/// A tool that goes deeper than the body can follow: it is counted, and the force stays.
TEST(MovingTouchTest, NoTetrahedronIsTurnedInsideOutSilently) {
  MovingTouch touch(soft_body(), ball(0.002), kTick);
  double most = 0.0, first = 0.0;
  const Vector3d over(0.0, kTop + 0.002, 0.0);
  touch.start(over);
  for (int i = 1; i <= 1500; ++i) {
    const double force = touch.tick(over - Vector3d(0.0, 1e-5 * i, 0.0), kTick).force.norm();
    ASSERT_TRUE(std::isfinite(force));
    most = std::max(most, force);
    first = touch.counts().inverted == 0 ? std::max(first, force) : first;
  }
  EXPECT_GT(touch.counts().inverted, 0u);
  EXPECT_GT(first, 0.05);
  EXPECT_LT(most, 1.3 * first);
}

/// Steps that are too long for the body: it flies apart, which is told, and nobody is hurt.
TEST(MovingTouchTest, ABodyThatFliesApartIsPutToRestAndTold) {
  MovingBody body = *soft_body();
  body.stable_step *= 4.0;
  MovingTouch touch(std::make_shared<const MovingBody>(body), ball(), kTick);
  const Vector3d over(0.0, kTop + kRadius, 0.0);
  touch.start(over);
  Vector3d before = Vector3d::Zero();
  for (int i = 1; i <= 500; ++i) {
    const Vector3d force = touch.tick(over - Vector3d(0.0, 3e-6 * i, 0.0), kTick).force;
    ASSERT_TRUE(force.allFinite()) << i;
    ASSERT_LT((force - before).norm(), 5000.0 * 3e-6 + 0.5 + 1e-9) << "nobody is struck";
    before = force;
  }
  EXPECT_GT(touch.counts().flown_apart, 0u);
}

/// A ball that is pressed through elements of 20 kPa at 0.1 m/s: their steps fail, and neither
/// before nor after that does the force change by more than the spring is bent, and 0.5 N.
TEST(MovingTouchTest, AForceThatABodyLosesGoesWithoutAStep) {
  const auto block = test::soft_block(8);
  const SharedMovingBody body =
      prepared(block, ImplicitTissue{{20e3, 0.4, 1000.0, {}}, 25.0}, kTick);
  MovingTouch touch(body, {0.005, 5000.0, {}}, kTick);
  const Vector3d over(0.001, kTop + 0.006, 0.0);
  touch.start(over);
  Vector3d before = Vector3d::Zero();
  double most = 0.0;
  for (int i = 1; i <= 300; ++i) {
    const Vector3d force = touch.tick(over - Vector3d(0.0, 1e-4 * i, 0.0), kTick).force;
    ASSERT_LT((force - before).norm(), 5000.0 * 1e-4 + 0.5 + 1e-9) << i;
    most = std::max(most, force.norm());
    before = force;
  }
  EXPECT_GT(touch.counts().flown_apart, 0u);
  EXPECT_GT(most, 3.0);
  EXPECT_EQ(before.norm(), 0.0);
}

TEST(MovingTouchTest, ABodyThatNeedsTooManyStepsIsRefused) {
  SpringTissue light = soft_springs();
  light.density = 1.0;
  const SharedMovingBody body = prepared(test::soft_block(12), light);
  try {
    MovingTouch touch(body, ball(), kTick);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("block: the longest stable step of its springs"));
    EXPECT_THAT(error.what(), testing::HasSubstr("at most 64 are allowed"));
  }
  EXPECT_LE(kTick / steps_on_a_tick(*soft_body(), kTick), kStableShare * soft_body()->stable_step);
}

/// The ball grows from what has room for it: what was overlapped is no blow.
TEST(MovingTouchTest, AHandThatBeginsInTheSurfaceIsNotThrownOut) {
  const Vector3d in(0.0, kTop + kRadius - 0.0015, 0.0);
  MovingTouch held(soft_body(), ball(), kTick);
  const double rest = press(held, in + Vector3d(0, 0.0015, 0), 0.0015, 0.01, 600).force.norm();
  MovingTouch touch(soft_body(), ball(), kTick);
  touch.start(in);
  double most = 0.0, last = 0.0;
  for (int i = 0; i < 600; ++i) {
    last = touch.tick(in, kTick).force.norm();
    most = std::max(most, last);
  }
  EXPECT_LT(most, 1.2 * rest);
  EXPECT_NEAR(last, rest, 0.01 * rest);
}

TEST(MovingTouchTest, AHandThatBeginsInsideFeelsNothingAndIsNotThrownOutWhenItLeaves) {
  MovingTouch touch(soft_body(), ball(), kTick);
  touch.start({0.0, kTop - 0.004, 0.0});
  double most = 0.0;
  for (int i = 0; i < 400; ++i) {
    const double y = kTop - 0.004 + 2e-5 * i;
    const double force = touch.tick({0.0, y, 0.0}, kTick).force.norm();
    const bool inside = y < kTop - 1e-9;  // the surface itself is there to rounding
    EXPECT_TRUE(!inside || force == 0.0) << i;
    most = std::max(most, force);
  }
  EXPECT_LT(most, 0.2);
  EXPECT_EQ(touch.counts().flown_apart, 0u);
}

TEST(MovingTouchTest, TheSameToolGivesTheSameBodyToTheBitAlsoWhenItIsAdopted) {
  MovingTouch first(soft_body(), ball(kRadius, 0.4), kTick);
  MovingTouch second(soft_body(), ball(kRadius, 0.4), kTick);
  MovingTouch third(soft_body(), ball(kRadius, 0.4), kTick);
  first.start({0.0, kTop + 0.007, 0.0});
  second.start({0.0, kTop + 0.007, 0.0});
  for (int i = 0; i < 400; ++i) {
    const Vector3d tool(2e-5 * i, kTop + 0.007 - 1e-5 * i, 1e-5 * std::sin(0.1 * i));
    const Vector3d felt = first.tick(tool, kTick).force;
    ASSERT_EQ(felt, second.tick(tool, kTick).force) << i;
    if (i == 250) {
      third.start({0.0, 1.0, 0.0});
      third.adopt(first, tool);
    } else if (i > 250) {
      ASSERT_EQ(felt, third.tick(tool, kTick).force) << i;
    }
  }
  for (std::size_t v = 0; v < first.motion().vertices(); ++v) {
    ASSERT_EQ(first.motion().position(v), second.motion().position(v));
    ASSERT_EQ(first.motion().position(v), third.motion().position(v));
  }
}

TEST(MovingTouchTest, ATickDoesNotAllocate) {
  const auto shape = std::make_shared<MovingShape>(soft_body()->springs.rest.size());
  MovingTouch touch(soft_body(), ball(kRadius, 0.4), kTick, shape);
  MovingTouch other(soft_body(), ball(kRadius, 0.4), kTick);
  const test::AllocationGuard guard;
  touch.start({0.0, kTop + 0.008, 0.0});
  for (int i = 0; i < 300; ++i) {
    touch.tick({1e-5 * i, kTop + 0.008 - 1e-5 * i, 0.0}, kTick);
  }
  other.adopt(touch, {0.0, kTop + 0.008, 0.0});
  EXPECT_EQ(guard.count(), 0);
  EXPECT_GT(touch.counts().contact, 50u);
}

TEST(MovingTouchTest, PicturesShowTheBodyAsItIs) {
  const auto shape = std::make_shared<MovingShape>(soft_body()->springs.rest.size());
  MovingTouch touch(soft_body(), ball(), kTick, shape);
  std::vector<Vector3d> seen(soft_body()->springs.rest.size(), Vector3d::Zero());
  EXPECT_FALSE(shape->read(seen));
  press(touch, {0.0, kTop + kRadius, 0.0}, 0.0015, 0.01, 100);
  ASSERT_TRUE(shape->read(seen));
  for (std::size_t v = 0; v < seen.size(); ++v) {
    ASSERT_LT((seen[v] - touch.motion().position(v)).norm(), 1e-6) << v;
  }
}

TEST(MovingTouchTest, AToolThatIsNotFiniteFeelsNothing) {
  MovingTouch touch(soft_body(), ball(), kTick);
  press(touch, {0.0, kTop + kRadius, 0.0}, 0.001, 0.01, 50);
  EXPECT_EQ(touch.tick({std::nan(""), 0.0, 0.0}, kTick).force.norm(), 0.0);
  EXPECT_TRUE(touch.forces().empty());
  EXPECT_GT(touch.tick({0.0, kTop + kRadius - 0.001, 0.0}, kTick).force.y(), 0.0);
}

}  // namespace
}  // namespace haptrial::deformable::moving_touch_test
