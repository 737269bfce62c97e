#include "core/control/swing_counter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/allocation_guard.h"

namespace haptrial::control::swing_counter_test {
namespace {

using Eigen::Vector3d;

constexpr double kTick = 1e-3;  // [s]

double sine(double hertz, double t) { return std::sin(2.0 * std::numbers::pi * hertz * t); }

/// The longest train within a second of this course of the force along y.
template <typename Force, typename Accounted>
SwingCounter::Alternation longest(Force force, Accounted accounted) {
  SwingCounter counter(1.0, 0.06);
  SwingCounter::Alternation longest;
  for (int i = 0; i < 1000; ++i) {
    const double t = kTick * i;
    const SwingCounter::Alternation train =
        counter.look(Vector3d(0.0, force(t), 0.0), Vector3d(0.0, accounted(t), 0.0), kTick);
    longest = train.turns > longest.turns ? train : longest;
  }
  return longest;
}
constexpr auto kNothing = [](double) { return 0.0; };

TEST(SwingCounterTest, ASineTurnsTwiceAPeriodAndSwingsByTwiceItsAmplitude) {
  for (const double hertz : {10.0, 20.0, 50.0}) {
    const auto train = longest([=](double t) { return 2.0 + 0.8 * sine(hertz, t); }, kNothing);
    EXPECT_NEAR(train.turns, 2.0 * hertz, 2.0) << hertz;
    EXPECT_NEAR(train.gap, 0.5 / hertz, 1.5 * kTick) << hertz;
    EXPECT_NEAR(train.swing, 1.6, 0.05) << hertz;
    EXPECT_NEAR(train.lasted, (train.turns - 1) * 0.5 / hertz, 3.0 * kTick) << hertz;
    EXPECT_NEAR(train.largest, 2.8, 0.05) << hertz;
  }
}

/// The force is that of a hand that trembles at a wall and leaves it in between.
TEST(SwingCounterTest, AForceThatStaysAtItsExtremeTurnsInTheMiddleOfThat) {
  const auto train =
      longest([](double t) { return std::max(0.0, 3.0 * sine(10.0, t) - 0.5); }, kNothing);
  EXPECT_NEAR(train.gap, 0.05, 1.5 * kTick);
}

TEST(SwingCounterTest, WhatIsTooSmallOrTooSlowIsNoTrain) {
  EXPECT_EQ(longest([](double t) { return 0.49 * sine(40.0, t); }, kNothing).turns, 0);
  EXPECT_LE(longest([](double t) { return 5.0 * sine(8.0, t); }, kNothing).turns, 2);
  EXPECT_LE(longest([](double t) { return t < 0.5 ? 0.0 : 6.0; }, kNothing).turns, 1);
}

TEST(SwingCounterTest, ATrainIsOverAfterAWhile) {
  SwingCounter counter(1.0, 0.06);
  SwingCounter::Alternation train;
  for (int i = 0; i < 500; ++i) {
    const double t = kTick * i;
    const double force = t < 0.2 ? 2.0 * sine(40.0, t) : 0.0;
    train = counter.look(Vector3d(force, 0.0, 0.0), Vector3d::Zero(), kTick);
  }
  EXPECT_EQ(train.turns, 0);
}

TEST(SwingCounterTest, AStimulusAccountsForItselfAndForAnAnswerOfItsSize) {
  const auto vibration = [](double t) { return 2.0 * sine(60.0, t); };
  EXPECT_GT(longest(vibration, kNothing).turns, 50);
  EXPECT_LE(longest(vibration, vibration).turns, 1);
  const auto damped = [&](double t) { return vibration(t) - 1.8 * sine(60.0, t - 0.004); };
  EXPECT_LE(longest(damped, vibration).turns, 1) << "a damper answers to it";
  const auto with_oscillation = [&](double t) { return vibration(t) + 4.0 * sine(45.0, t); };
  EXPECT_GT(longest(with_oscillation, vibration).turns, 50) << "and hides no larger one";
}

TEST(SwingCounterTest, ATickDoesNotAllocate) {
  SwingCounter counter(1.0, 0.06);
  const test::AllocationGuard guard;
  for (int i = 0; i < 1000; ++i) {
    counter.look(Vector3d(3.0 * std::sin(i), 0.0, 0.0), Vector3d(std::cos(i), 0.0, 0.0), kTick);
  }
  EXPECT_EQ(guard.count(), 0u);
}

}  // namespace
}  // namespace haptrial::control::swing_counter_test
