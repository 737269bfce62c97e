#include "core/deformable/touch/two_rate_touch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <numbers>
#include <thread>
#include <vector>

#include "core/base/error.h"
#include "core/base/random.h"
#include "core/deformable/springs/spring_tangent.h"
#include "tests/core/deformable/touch/soft_block.h"
#include "tests/support/allocation_guard.h"

namespace haptrial::deformable::two_rate_touch_test {
namespace {

using Eigen::Vector3d;

constexpr double kTop = 0.012;  // of the soft block [m]
constexpr double kTick = 0.001;
constexpr double kRadius = 0.006;
constexpr int kWindow = 4;

SharedMovingBody soft_body() {
  const double cell = 0.048 / 12;
  const double energy = 15e3 * cell * cell * cell;
  return prepared(test::soft_block(12),
                  SpringTissue{{0.5 * energy, 0.2 * energy, energy}, nullptr, 1000.0, 25.0});
}

SharedWindowCompliance soft_compliance() {
  return prepared_compliance(soft_body(), kWindow * kTick);
}

TouchOptions ball(double friction = 0.0) { return {kRadius, 5000.0, {friction, 0.8 * friction}}; }

TwoRateTouch slow_touch(double friction = 0.0) {
  return {soft_body(), soft_compliance(), ball(friction), kTick, {kWindow, false}};
}

/// Down into the middle with a speed, then still.
Vector3d pressing(int tick, double speed = 0.01, double depth = 0.0015) {
  const double down = std::min(speed * kTick * tick, depth + 0.0005);
  return {0.0013, kTop + kRadius + 0.0005 - down, 0.0007};
}

/// Wanders over the top, in and out of contact.
Vector3d wandering(int tick) {
  const double t = 2e-3 * tick;
  return {0.008 * std::sin(t), kTop + kRadius - 0.0005 - 0.001 * std::sin(1.7 * t - 1.5),
          0.008 * std::sin(0.8 * t)};
}

TEST(WindowComplianceTest, OverALongTimeItIsThatOfTheStatics) {
  const SharedMovingBody body = soft_body();
  const WindowCompliance gives(*body, 1e3);
  std::vector<Hold> holds;
  for (const std::int32_t v : body->held) {
    holds.push_back({v, Vector3d::Zero()});
  }
  const std::int32_t pressed = body->mesh->felt[body->mesh->felt.size() / 2][0];
  std::vector<Vector3d> forces(body->springs.rest.size(), Vector3d::Zero());
  forces[static_cast<std::size_t>(pressed)] = {0.1, -0.3, 0.2};
  const auto moved = small_displacements(body->springs, holds, body->springs.rest, forces);
  ASSERT_TRUE(moved);
  for (const Face& face : body->mesh->felt) {
    for (const std::int32_t v : face) {
      const Eigen::Vector3f u = gives.block(v, pressed) * Eigen::Vector3f(0.1F, -0.3F, 0.2F);
      const Vector3d& expected = (*moved)[static_cast<std::size_t>(v)];
      ASSERT_LT((u.cast<double>() - expected).norm(), 1e-7) << v;
    }
  }
  EXPECT_GT((*moved)[static_cast<std::size_t>(pressed)].norm(), 1e-3);
  const WindowCompliance soon(*body, 1e-3);
  EXPECT_LT(soon.block(pressed, pressed)(1, 1), 0.9F * gives.block(pressed, pressed)(1, 1))
      << "inertia holds";
}

/// The body itself gives up nothing.
TEST(SlowBodyTest, TheBodyMovesToTheBitAsAtTheLoopsRate) {
  SlowBody slow(soft_body(), soft_compliance(), ball(0.3), kTick, kWindow, false, nullptr);
  MovingTouch one(soft_body(), ball(0.3), kTick);
  BodyPath path;
  path.starts = true;
  path.from = wandering(0);
  one.start(path.from);
  std::size_t pressed = 0;
  for (int tick = 1; tick <= 800; ++tick) {
    one.tick(wandering(tick), kTick);
    path.tools[static_cast<std::size_t>(path.count++)] = wandering(tick);
    if (path.count < kWindow) {
      continue;
    }
    slow.give(path);
    const LocalSurface* surface = slow.take();
    ASSERT_NE(surface, nullptr);
    for (std::size_t i = 0; i < surface->count; ++i) {
      const LocalSurface::Place& place = surface->places[i];
      Vector3d at = Vector3d::Zero();
      for (std::size_t k = 0; k < 3; ++k) {
        at += place.sample.weight[static_cast<Eigen::Index>(k)] *
              one.motion().position(static_cast<std::size_t>(place.sample.corners[k]));
      }
      ASSERT_LT((at - place.at).norm(), 1e-15) << tick;
      pressed += place.pressed ? 1 : 0;
    }
    path.starts = false;
    path.count = 0;
    path.from = wandering(tick);
  }
  EXPECT_GT(pressed, 100u);
}

TEST(TwoRateTouchTest, HeldStillItFeelsWhatTheLoopsRateFeels) {
  for (const double friction : {0.0, 0.4}) {
    TwoRateTouch two = slow_touch(friction);
    MovingTouch one(soft_body(), ball(friction), kTick);
    two.start(pressing(0));
    one.start(pressing(0));
    Vector3d felt = Vector3d::Zero(), expected = Vector3d::Zero();
    for (int tick = 1; tick <= 900; ++tick) {
      felt = two.tick(pressing(tick), kTick).force;
      expected = one.tick(pressing(tick), kTick).force;
    }
    EXPECT_GT(expected.y(), 0.1);
    EXPECT_LT((felt - expected).norm(), 0.01 * expected.norm()) << friction;
    EXPECT_EQ(two.counts().limited, 0u);
  }
}

/// The tool goes in and out of contact with up to 20 mm/s, without friction.
TEST(TwoRateTouchTest, OnASmoothPathItFeelsWhatTheLoopsRateFeels) {
  TwoRateTouch two = slow_touch();
  MovingTouch one(soft_body(), ball(), kTick);
  two.start(wandering(0));
  one.start(wandering(0));
  double off = 0.0, size = 0.0;
  for (int tick = 1; tick <= 4000; ++tick) {
    const Vector3d felt = two.tick(wandering(tick), kTick).force;
    const Vector3d expected = one.tick(wandering(tick), kTick).force;
    if (tick > 100) {
      off += (felt - expected).squaredNorm();
      size += expected.squaredNorm();
    }
  }
  EXPECT_LT(std::sqrt(off / size), 0.05);
  EXPECT_GT(two.counts().contact, 1000u);
  EXPECT_LT(two.counts().contact, 3900u);
}

/// The paths are those of MovingTouchTest: closed ones of a hand, smooth and shaking.
TEST(TwoRateTouchTest, AClosedPathGivesNoEnergy) {
  for (const double shake : {0.0, 1e-4, 5e-4}) {
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      TwoRateTouch touch = slow_touch(seed % 2 == 0 ? 0.4 : 0.0);
      RandomStream random(seed, "path");
      const Vector3d start(0.0, kTop + kRadius + 0.0005, 0.0);
      constexpr int kTicks = 1000;
      touch.start(start);
      double given = 0.0, taken = 0.0;
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
      EXPECT_EQ(touch.counts().flown_apart, 0u);
      EXPECT_GT(touch.counts().contact, 500u);
    }
  }
}

TEST(TwoRateTouchTest, WhatIsFeltIsOnTheVertices) {
  TwoRateTouch touch = slow_touch(0.3);
  touch.start(wandering(0));
  for (int tick = 1; tick <= 600; ++tick) {
    const contact::Contact& felt = touch.tick(wandering(tick), kTick);
    Vector3d sum = Vector3d::Zero();
    for (const VertexForce& each : touch.forces()) {
      sum += each.force.cast<double>();
    }
    ASSERT_TRUE(touch.counts().limited > 0 ||
                (felt.force + sum).norm() < 1e-6 * felt.force.norm() + 1e-9)
        << tick;
  }
}

/// A body on a thread, once with the time that it needs and once without.
TEST(TwoRateTouchTest, WhatAThreadGaveIsRepeatedToTheBitHoweverLateItWas) {
  for (const int microseconds : {1500, 20}) {
    TwoRateTouch live(soft_body(), soft_compliance(), ball(0.3), kTick, {kWindow, true});
    std::vector<Vector3d> felt;
    live.start(wandering(0));
    for (int tick = 1; tick <= 700; ++tick) {
      if (tick == 350) {
        live.start(wandering(tick));
      }
      felt.push_back(live.tick(wandering(tick), kTick).force);
      std::this_thread::sleep_for(std::chrono::microseconds(microseconds));
    }
    TwoRates again{kWindow, false, {live.late().begin(), live.late().end()}};
    TwoRateTouch repeated(soft_body(), soft_compliance(), ball(0.3), kTick, again);
    repeated.start(wandering(0));
    for (int tick = 1; tick <= 700; ++tick) {
      if (tick == 350) {
        repeated.start(wandering(tick));
      }
      ASSERT_EQ(repeated.tick(wandering(tick), kTick).force,
                felt[static_cast<std::size_t>(tick - 1)])
          << tick << " " << microseconds;
    }
    EXPECT_EQ(repeated.counts().late, live.counts().late);
    EXPECT_TRUE(std::ranges::equal(repeated.late(), live.late()));
    if (microseconds < 100) {
      EXPECT_GT(live.counts().late, 0u) << "a window of four ticks takes longer than they";
    } else {
      EXPECT_GT(live.counts().contact, 100u);
    }
  }
}

TEST(TwoRateTouchTest, ATickDoesNotAllocate) {
  const auto shape = std::make_shared<MovingShape>(soft_body()->springs.rest.size());
  TwoRateTouch stepped(soft_body(), soft_compliance(), ball(0.4), kTick, {kWindow, false}, shape);
  TwoRateTouch threaded(soft_body(), soft_compliance(), ball(0.4), kTick, {kWindow, true});
  const test::AllocationGuard guard;
  for (TwoRateTouch* touch : {&stepped, &threaded}) {
    touch->start(wandering(0));
    for (int tick = 1; tick <= 800; ++tick) {
      touch->tick(wandering(tick), kTick);
    }
  }
  EXPECT_EQ(guard.count(), 0);
  EXPECT_GT(stepped.counts().contact, 50u);
}

TEST(TwoRateTouchTest, AToolThatIsNotFiniteFeelsNothing) {
  TwoRateTouch touch = slow_touch();
  touch.start(pressing(0));
  for (int tick = 1; tick <= 300; ++tick) {
    touch.tick(pressing(tick), kTick);
  }
  EXPECT_EQ(touch.tick({std::nan(""), 0.0, 0.0}, kTick).force.norm(), 0.0);
  EXPECT_TRUE(touch.forces().empty());
  EXPECT_GT(touch.tick(pressing(301), kTick).force.y(), 0.0);
}

TEST(TwoRateTouchTest, RatesAreRefusedWithASentence) {
  const auto shared = test::soft_block(12);
  const HapticMesh& block = *shared;
  EXPECT_EQ(ticks_of_window(block, 1000.0, 250.0), 4);
  EXPECT_EQ(ticks_of_window(block, 4000.0, 4000.0), 1);
  const auto refused = [](const HapticMesh& body, double rate) {
    try {
      ticks_of_window(body, 1000.0, rate);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  for (const double rate : {300.0, 2000.0, 10.0}) {
    EXPECT_THAT(refused(block, rate), testing::HasSubstr("Hz; allowed: the 1000 Hz of the loop"));
  }
  HapticMesh held = block;
  held.grasped = {0};
  EXPECT_THAT(refused(held, 250.0), testing::HasSubstr("keep `grasped` or `rate`"));
}

}  // namespace
}  // namespace haptrial::deformable::two_rate_touch_test
