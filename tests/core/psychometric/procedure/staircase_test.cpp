#include "core/psychometric/procedure/staircase.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "core/psychometric/function/response_observer.h"
#include "tests/support/message_of.h"

namespace haptrial::psychometric {
namespace {

using Parameters = StaircaseParameters;

Parameters ten_steps() {
  Parameters p;
  p.start = 5.0;
  p.low = 0.0;
  p.high = 10.0;
  p.steps = {{1.0, 1.0, 0}};
  p.stop_trials = 1000;
  return p;
}

/// Levels presented while these answers are given, the one after them too.
std::vector<double> track(Parameters p, const std::vector<int>& answers) {
  Staircase staircase(p);
  std::vector<double> levels{staircase.next()[0]};
  for (int answer : answers) {
    staircase.report(answer, staircase.next());
    levels.push_back(staircase.next()[0]);
  }
  return levels;
}

using Levels = std::vector<double>;

TEST(StaircaseTest, TwoDownOneUp) {
  EXPECT_EQ(track(ten_steps(), {1, 1, 1, 1, 0, 1, 0, 1, 1}),
            (Levels{5, 5, 4, 4, 3, 4, 4, 5, 5, 4}));
}

TEST(StaircaseTest, CountsInSequenceOrInAll) {
  auto p = ten_steps();
  p.up = 2;
  EXPECT_EQ(track(p, {0, 1, 0, 1, 1}), (Levels{5, 5, 5, 5, 5, 4}));
  p.counting = Parameters::Counting::kInAll;
  EXPECT_EQ(track(p, {0, 1, 0, 1, 1}), (Levels{5, 5, 5, 6, 6, 5}));
}

TEST(StaircaseTest, AnotherRuleBeforeTheFirstReversal) {
  auto p = ten_steps();
  p.first_down = 1;
  EXPECT_EQ(track(p, {1, 1, 0, 1, 1}), (Levels{5, 4, 3, 4, 4, 3}));
}

TEST(StaircaseTest, StepsByReversalAndByTrial) {
  auto p = ten_steps();
  p.down = 1;
  p.steps = {{2.0, 1.0, 0}, {0.5, 0.25, 1}};
  EXPECT_EQ(track(p, {1, 0, 1, 1}), (Levels{5, 3, 3.25, 2.75, 2.25}));
  p.schedule = Parameters::Schedule::kTrials;
  p.steps[1].from = 3;
  EXPECT_EQ(track(p, {1, 0, 1, 1}), (Levels{5, 3, 4, 3.5, 3}));
}

TEST(StaircaseTest, HarderCanBeHigher) {
  auto p = ten_steps();
  p.right_raises = true;
  EXPECT_EQ(track(p, {1, 1, 0}), (Levels{5, 5, 6, 5}));
}

TEST(StaircaseTest, StepsOnALogarithmicAxis) {
  auto p = ten_steps();
  p.axis = {Scale::kLog10, 300.0};
  p.start = 400.0;
  p.low = 301.0;
  p.high = 600.0;
  p.down = 1;
  p.steps = {{1.0, 1.0, 0}};
  const auto levels = track(p, {1, 1, 1, 0});
  EXPECT_NEAR(levels[1], 310.0, 1e-9);
  EXPECT_NEAR(levels[2], 301.0, 1e-9);
  EXPECT_NEAR(levels[3], 301.0, 1e-9);  // the bound
  EXPECT_NEAR(levels[4], 310.0, 1e-9);
}

TEST(StaircaseTest, WhatHappensAtABound) {
  auto p = ten_steps();
  p.down = 1;
  p.start = 1.0;
  const std::vector<int> answers{1, 1, 1, 0};
  EXPECT_EQ(track(p, answers), (Levels{1, 0, 0, 0, 1}));
  const auto reversals = [&] {
    Staircase staircase(p);
    for (int answer : answers) {
      staircase.report(answer, staircase.next());
    }
    return staircase.state().reversals;
  };
  EXPECT_EQ(reversals(), 1);
  p.at_bound = Parameters::AtBound::kHoldUncounted;
  EXPECT_EQ(reversals(), 0);
  p.at_bound = Parameters::AtBound::kEnd;
  p.blocked_steps = 2;
  Staircase staircase(p);
  replay(staircase, std::vector<Outcome>{{1.0, {1.0}}, {1.0, {0.0}}});
  EXPECT_FALSE(staircase.finished());
  staircase.report(1, {0.0});
  EXPECT_TRUE(staircase.finished());
  EXPECT_THROW(staircase.next(), std::logic_error);
}

TEST(StaircaseTest, StopsByTheFirstOfTrialsAndReversals) {
  auto p = ten_steps();
  p.down = 1;
  p.stop_reversals = 3;
  Staircase by_reversals(p);
  for (int answer : {1, 0, 1}) {
    by_reversals.report(answer, by_reversals.next());
    EXPECT_FALSE(by_reversals.finished());
  }
  by_reversals.report(0, by_reversals.next());
  EXPECT_TRUE(by_reversals.finished());
  p.stop_trials = 2;
  Staircase by_trials(p);
  by_trials.report(1, by_trials.next());
  by_trials.report(0, by_trials.next());
  EXPECT_TRUE(by_trials.finished());
  EXPECT_THROW(by_trials.report(1, {5.0}), std::logic_error);
}

TEST(StaircaseTest, LearnsFromTheLevelThatWasApplied) {
  auto p = ten_steps();
  p.down = 1;
  Staircase staircase(p);
  staircase.report(1, {5.2});
  EXPECT_DOUBLE_EQ(staircase.next()[0], 4.2);
  staircase.report(0, {4.3});
  EXPECT_EQ(staircase.reversals(), (Levels{4.3}));
  p.step_from_applied = false;
  Staircase own(p);
  own.report(1, {5.2});
  EXPECT_DOUBLE_EQ(own.next()[0], 4.0);
}

// Levels 5 4 3 4 3 2 3 with turns at 3, 4, 2.
TEST(StaircaseTest, EstimatorsOfATrackByHand) {
  auto p = ten_steps();
  p.down = 1;
  const auto estimate = [&] {
    Staircase staircase(p);
    for (int answer : {1, 1, 0, 1, 1, 0}) {
      staircase.report(answer, staircase.next());
    }
    return staircase.estimates();
  };
  EXPECT_DOUBLE_EQ(estimate()[0].value, 3.0);
  EXPECT_EQ(estimate()[0].name, "mean of 3 reversals");
  EXPECT_FALSE(estimate()[0].deviation);  // one pair
  p.last = 1;
  EXPECT_DOUBLE_EQ(estimate()[0].value, 2.0);
  p.last = 0;
  p.skip = 1;
  EXPECT_DOUBLE_EQ(estimate()[0].value, 3.0);
  p.estimator = Parameters::Estimator::kMeanOfLevels;
  p.skip = 4;
  EXPECT_DOUBLE_EQ(estimate()[0].value, 2.5);
  p.estimator = Parameters::Estimator::kMedianOfReversals;
  p.skip = 0;
  EXPECT_DOUBLE_EQ(estimate()[0].value, 3.0);
  p.skip = 3;
  EXPECT_TRUE(estimate().empty());
}

// Turns at 4 5 3 4: middles 4.5 and 3.5, standard error 0.5.
TEST(StaircaseTest, DeviationFromMiddlesOfPairs) {
  auto p = ten_steps();
  p.down = 1;
  Staircase staircase(p);
  for (int answer : {1, 0, 1, 1, 0, 1}) {
    staircase.report(answer, staircase.next());
  }
  EXPECT_EQ(staircase.reversals(), (Levels{4, 5, 3, 4}));
  EXPECT_EQ(staircase.counted_reversals(), 4);
  EXPECT_NEAR(staircase.estimates()[0].deviation.value(), 0.5, 1e-12);
}

TEST(StaircaseTest, AWeightedStepBalancesAtItsTarget) {
  EXPECT_DOUBLE_EQ(balance_of(1, {1.0, 3.0, 0}), 0.75);  // up / down = target / (1 - target)
  EXPECT_NEAR(balance_of(2, {1.0, 1.0, 0}), std::sqrt(0.5), 1e-15);
}

// García-Pérez 1998: ratios of down to up, and the percentages where they converge.
TEST(StaircaseTest, RatiosOfGarciaPerezBalanceAtHisPercentages) {
  const double ratios[] = {0.2845, 0.5488, 0.7393, 0.8415};
  const double percent[] = {77.85, 80.35, 83.15, 85.84};
  for (int n = 1; n <= 4; ++n) {
    EXPECT_NEAR(100.0 * balance_of(n, {ratios[n - 1], 1.0, 0}), percent[n - 1], 0.006);
  }
}

TEST(StaircaseTest, ParametersOutOfBoundsAreNamed) {
  const auto message = [](auto&& change) {
    auto p = ten_steps();
    change(p);
    return test::message_of<std::invalid_argument>([&] { Staircase staircase(p); });
  };
  const auto names = [&](const char* name, auto&& change) {
    EXPECT_NE(message(change).find(name), std::string::npos) << name << ": " << message(change);
  };
  names("start", [](auto& p) { p.start = 11.0; });
  names("high", [](auto& p) { p.high = -1.0; });
  names("down", [](auto& p) { p.down = 0; });
  names("steps", [](auto& p) { p.steps.clear(); });
  names("steps", [](auto& p) { p.steps[0].up = 0.0; });
  names("stop_reversals or stop_trials", [](auto& p) { p.stop_trials = 0; });
  names("skip and last", [](auto& p) { p.skip = p.last = 1; });
  names("low", [](auto& p) { p.axis.scale = Scale::kLog10; });
}

TEST(StaircaseTest, AWrongReportLeavesTheStateUnchanged) {
  Staircase staircase(ten_steps());
  EXPECT_THROW(staircase.report(2, {5.0}), std::invalid_argument);
  EXPECT_THROW(staircase.report(0.5, {5.0}), std::invalid_argument);
  EXPECT_THROW(staircase.report(1, {NAN}), std::invalid_argument);
  EXPECT_THROW(staircase.report(1, {5.0, 5.0}), std::invalid_argument);
  EXPECT_EQ(staircase.state(), begin(ten_steps()));
}

}  // namespace
}  // namespace haptrial::psychometric
