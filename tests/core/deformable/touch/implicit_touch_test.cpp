// A body of elements that moves by implicit steps is felt through the same touch as one of springs.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/random.h"
#include "core/deformable/elements/static_solver.h"
#include "core/deformable/touch/two_rate_touch.h"
#include "tests/core/deformable/touch/soft_block.h"
#include "tests/support/allocation_guard.h"

namespace haptrial::deformable::implicit_touch_test {
namespace {

using Eigen::Vector3d;

constexpr double kTop = 0.012;  // of the soft block [m]
constexpr double kTick = 0.001;
constexpr int kWindow = 4;
constexpr double kRadius = 0.006;

SharedMovingBody elements(double step, double poisson = 0.45) {
  return prepared(test::soft_block(12), ImplicitTissue{{15e3, poisson, 1000.0, {}}, 25.0}, step);
}

SharedMovingBody springs() {
  const double cell = 0.048 / 12;
  const double energy = 15e3 * cell * cell * cell;
  return prepared(test::soft_block(12),
                  SpringTissue{{0.5 * energy, 0.2 * energy, energy}, nullptr, 1000.0, 25.0});
}

TouchOptions ball(double friction = 0.0) { return {kRadius, 5000.0, {friction, 0.8 * friction}}; }

TwoRateTouch at_250_hz(const SharedMovingBody& body, double friction = 0.0) {
  return {
      body, prepared_compliance(body, kWindow * kTick), ball(friction), kTick, {kWindow, false}};
}

/// The ball's way into the block and out again, over a second.
Vector3d closed_path(double share) {
  const double t = 2.0 * std::numbers::pi * share;
  const double down = 0.5 - 0.5 * std::cos(t);
  return Vector3d(0.0, kTop + kRadius + 0.0005, 0.0) +
         Vector3d(0.004 * std::sin(3.0 * t) * down, -0.003 * down * (1.0 + 0.3 * std::sin(7.0 * t)),
                  0.0);
}

/// Pressed and held, with friction, too, the body is where its elements balance the ball's forces.
TEST(ImplicitTouchTest, HeldStillItIsTheEquilibriumOfItsElementsOnTheBall) {
  for (const double friction : {0.0, 0.3}) {
    const SharedMovingBody body = elements(0.004);
    MovingTouch touch(body, ball(friction), 0.004);
    const Vector3d over(0.0013, kTop + kRadius, 0.0007);
    touch.start(over + Vector3d(0.0, 0.0005, 0.0));
    contact::Contact felt;
    for (int i = 1; i <= 300; ++i) {
      felt =
          touch.tick(over + Vector3d(0.0, 0.0005 - 0.0025 * std::min(1.0, i / 60.0), 0.0), 0.004);
    }
    LoadCase load{"ball", {}, {}};
    Vector3d sum = Vector3d::Zero();
    for (const std::int32_t v : body->held) {
      load.holds.push_back({v, Vector3d::Zero()});
    }
    for (const VertexForce& each : touch.forces()) {
      load.forces.push_back({each.vertex, each.force.cast<double>()});
      sum += each.force.cast<double>();
    }
    const StaticResult rest = solve_static(*body->elements, load);
    double farthest = 0.0, moved = 0.0;
    for (std::size_t v = 0; v < rest.displacement.size(); ++v) {
      const Vector3d u = touch.motion().position(v) - body->mesh->tets.vertices[v];
      farthest = std::max(farthest, (u - rest.displacement[v]).norm());
      moved = std::max(moved, u.norm());
    }
    EXPECT_GT(moved, 0.0015);
    EXPECT_LT(farthest, 1e-3 * moved) << friction;
    EXPECT_LT((felt.force + sum).norm(), 1e-6 * sum.norm());
    EXPECT_EQ(touch.counts().unsettled, 0u);
  }
}

/// Smooth and shaking hands, the force held over each tick: as MovingTouchTest has it of springs.
TEST(ImplicitTouchTest, AClosedPathGivesNoEnergy) {
  for (const double shake : {0.0, 5e-4}) {
    TwoRateTouch touch = at_250_hz(elements(kWindow * kTick), 0.3);
    RandomStream random(1, "path");
    Vector3d held = Vector3d::Zero(), before = closed_path(0.0);
    touch.start(before);
    constexpr int kTicks = 1000;
    double given = 0.0, taken = 0.0;
    std::uint64_t contacts = 0;
    for (int i = 1; i <= kTicks; ++i) {
      const Vector3d noise(random.normal(), random.normal(), random.normal());
      const Vector3d at =
          closed_path(static_cast<double>(i) / kTicks) + (i < kTicks ? shake : 0.0) * noise;
      given += held.dot(at - before);
      taken += EnergyAccount::kDamping * (at - before).squaredNorm() / kTick;
      const bool free = held.isZero(0.0);
      held = touch.tick(at, kTick).force;
      contacts += free && !held.isZero(0.0) ? 1 : 0;
      before = at;
    }
    EXPECT_LT(given, taken + EnergyAccount::kLoan * static_cast<double>(contacts)) << shake;
    EXPECT_EQ(touch.counts().flown_apart, 0u);
    EXPECT_GT(touch.counts().contact, 500u);
  }
}

/// The largest change of force from tick to tick on a smooth path [N].
double largest_step(const SharedMovingBody& body) {
  TwoRateTouch touch = at_250_hz(body);
  touch.start(closed_path(0.0));
  Vector3d before = Vector3d::Zero();
  double step = 0.0;
  for (int i = 1; i <= 1000; ++i) {
    const Vector3d now = touch.tick(closed_path(i / 1000.0), kTick).force;
    step = std::max(step, (now - before).norm());
    before = now;
  }
  return step;
}

TEST(ImplicitTouchTest, ItsForceStepsNoMoreThanThatOfSprings) {
  const double of_elements = largest_step(elements(kWindow * kTick, 0.3));
  const double of_springs = largest_step(springs());
  EXPECT_GT(of_springs, 0.005);
  EXPECT_LT(of_elements, of_springs);
}

TEST(ImplicitTouchTest, ATickDoesNotAllocate) {
  TwoRateTouch touch = at_250_hz(elements(kWindow * kTick), 0.3);
  touch.start(closed_path(0.0));
  const test::AllocationGuard guard;
  for (int i = 1; i <= 200; ++i) {
    touch.tick(closed_path(0.3 + i / 1000.0), kTick);
  }
  EXPECT_EQ(guard.count(), 0u);
}

}  // namespace
}  // namespace haptrial::deformable::implicit_touch_test
