#include "core/psychometric/procedure/staircase_chain.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "core/base/random.h"
#include "core/psychometric/function/psychometric_function.h"
#include "core/psychometric/procedure/staircase.h"

namespace haptrial::psychometric {
namespace {

using Parameters = StaircaseParameters;

/// 0.5 + 0.5 Phi(x): levels in units of sigma.
double two_alternatives(double x) { return 0.5 + 0.25 * std::erfc(-x / std::sqrt(2.0)); }

Parameters two_down_one_up(double step) {
  Parameters p;
  p.start = 0.0;
  p.low = -8.0;
  p.high = 8.0;
  p.steps = {{step, step, 0}};
  p.stop_trials = 60;
  return p;
}

// A chance of 1/2 everywhere, one step down and up: the turn of a fair coin. Reversals come with a
// probability of 1/2 from the second trial on, and the mean of the levels stays at the start.
TEST(StaircaseChainTest, AFairCoin) {
  Parameters p;
  p.start = 0.0;
  p.low = -1000.0;
  p.high = 1000.0;
  p.down = 1;
  p.steps = {{1.0, 1.0, 0}};
  p.stop_reversals = 6;
  const auto predicted = predict_staircase(
      p, [](double) { return 0.5; }, 0.0);
  EXPECT_NEAR(predicted.trials, 13.0, 1e-9);                       // 1 + 6 / (1/2)
  EXPECT_NEAR(predicted.trials_deviation, std::sqrt(12.0), 1e-9);  // negative binomial
  EXPECT_NEAR(predicted.mean, 0.0, 1e-9);
  p.stop_reversals = 0;
  p.stop_trials = 10;
  p.estimator = Parameters::Estimator::kMeanOfLevels;
  const auto levels = predict_staircase(
      p, [](double) { return 0.5; }, -1.0);
  EXPECT_NEAR(levels.mean, 0.0, 1e-12);
  EXPECT_NEAR(levels.bias, 1.0, 1e-12);
  // Variance of the mean of a random walk S_0 .. S_9: sum over j of (10 - j)² / 100, j = 1 .. 9.
  EXPECT_NEAR(levels.deviation, std::sqrt(2.85), 1e-12);
}

/// Every sequence of answers, each with its probability: the prediction without a chain.
StaircasePrediction by_enumeration(const Parameters& p, double target) {
  double mass = 0.0, sum = 0.0, square = 0.0, trials = 0.0;
  for (int code = 0; code < 1 << p.stop_trials; ++code) {
    Staircase staircase(p);
    double probability = 1.0;
    int count = 0;
    while (!staircase.finished()) {
      const int answer = code >> count & 1;
      const double right = two_alternatives(staircase.next()[0]);
      probability *= answer == 1 ? right : 1.0 - right;
      staircase.report(answer, staircase.next());
      ++count;
    }
    if ((code >> count) != 0) {
      continue;  // the same track as another sequence
    }
    trials += probability * count;
    const auto estimates = staircase.estimates();
    if (!estimates.empty()) {
      mass += probability;
      sum += probability * estimates[0].value;
      square += probability * estimates[0].value * estimates[0].value;
    }
  }
  const double mean = sum / mass;
  return {mean, std::sqrt(square / mass - mean * mean), mean - target, 1.0 - mass, trials, 0.0};
}

TEST(StaircaseChainTest, EveryRuleAgainstAllSequencesOfAnswers) {
  std::vector<Parameters> all;
  auto p = two_down_one_up(0.7);
  p.stop_trials = 14;
  p.start = 1.1;
  all.push_back(p);
  p.last = 2;
  all.push_back(p);
  p.stop_reversals = 4;
  all.push_back(p);
  p.last = 3;
  p.steps = {{1.0, 0.8, 0}, {0.5, 0.3, 2}};
  all.push_back(p);
  p.first_down = 1;
  p.last = 0;
  p.skip = 1;
  all.push_back(p);
  p.low = 0.3;
  p.high = 2.0;
  p.at_bound = Parameters::AtBound::kHoldUncounted;
  all.push_back(p);
  p.at_bound = Parameters::AtBound::kEnd;
  p.blocked_steps = 2;
  all.push_back(p);
  p = all[0];
  p.up = 2;
  p.counting = Parameters::Counting::kInAll;
  p.schedule = Parameters::Schedule::kTrials;
  p.steps = {{1.0, 0.8, 0}, {0.5, 0.3, 5}};
  all.push_back(p);
  p.estimator = Parameters::Estimator::kMeanOfLevels;
  p.last = 6;
  p.right_raises = true;
  all.push_back(p);
  p.last = 0;
  p.skip = 3;
  all.push_back(p);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto exact = by_enumeration(all[i], 0.5);
    const auto chain = predict_staircase(all[i], two_alternatives, 0.5);
    EXPECT_NEAR(chain.mean, exact.mean, 1e-10) << i;
    EXPECT_NEAR(chain.deviation, exact.deviation, 1e-8) << i;
    EXPECT_NEAR(chain.bias, exact.bias, 1e-10) << i;
    EXPECT_NEAR(chain.without_estimate, exact.without_estimate, 1e-10) << i;
    EXPECT_NEAR(chain.trials, exact.trials, 1e-10) << i;
  }
}

TEST(StaircaseChainTest, LongRunsAgainstSimulation) {
  auto p = two_down_one_up(0.5);
  p.start = 3.0;
  p.steps = {{1.0, 1.0, 0}, {0.25, 0.25, 2}};
  p.stop_trials = 0;
  p.stop_reversals = 10;
  p.last = 6;
  constexpr int kRuns = 20'000;
  RandomStream random(1, "answers");
  double sum = 0.0, square = 0.0, trials = 0.0;
  for (int i = 0; i < kRuns; ++i) {
    Staircase staircase(p);
    while (!staircase.finished()) {
      const int right = random.uniform() < two_alternatives(staircase.next()[0]);
      staircase.report(right, staircase.next());
    }
    const double value = staircase.estimates()[0].value;
    sum += value;
    square += value * value;
    trials += staircase.state().trials;
  }
  const double mean = sum / kRuns;
  const double deviation = std::sqrt(square / kRuns - mean * mean);
  const auto predicted = predict_staircase(p, two_alternatives, 0.5449);
  EXPECT_NEAR(predicted.mean, mean, 4.0 * deviation / std::sqrt(1.0 * kRuns));
  EXPECT_NEAR(predicted.deviation / deviation, 1.0, 0.03);
  EXPECT_NEAR(predicted.trials, trials / kRuns,
              4.0 * predicted.trials_deviation / std::sqrt(1.0 * kRuns));
}

TEST(StaircaseChainTest, WhatCannotBePredictedSaysSo) {
  auto p = two_down_one_up(0.5);
  p.estimator = Parameters::Estimator::kMedianOfReversals;
  EXPECT_THROW(predict_staircase(p, two_alternatives, 0.0), std::invalid_argument);
  p.estimator = Parameters::Estimator::kMeanOfLevels;
  p.stop_reversals = 5;
  EXPECT_THROW(predict_staircase(p, two_alternatives, 0.0), std::invalid_argument);
  p = two_down_one_up(0.5);
  EXPECT_THROW(predict_staircase(
                   p, [](double) { return 1.5; }, 0.0),
               std::invalid_argument);
}

}  // namespace
}  // namespace haptrial::psychometric
