#include "analysis/reaching/two_rate.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "core/base/random.h"

namespace haptrial::analysis {
namespace {

struct TwoRateState {
  double fast{0.0};   // x_f before the trial
  double slow{0.0};   // x_s
  double error{0.0};  // e, in units of the perturbation
  double measured{0.0};
  double adaptation() const { return fast + slow; }
};

/// The model over a sequence; `measured` of the trials is not read.
std::vector<TwoRateState> two_rate_states(const TwoRateModel& model,
                                          std::span<const AdaptationTrial> trials) {
  std::vector<TwoRateState> states;
  TwoRateState now;
  for (const AdaptationTrial& trial : trials) {
    now.error = trial.error_clamp ? 0.0 : trial.perturbation - now.adaptation();
    now.measured = trial.error_clamp ? now.adaptation() : model.error_scale * now.error;
    states.push_back(now);
    now.fast = model.fast.retention * now.fast + model.fast.learning * now.error;
    now.slow = model.slow.retention * now.slow + model.slow.learning * now.error;
  }
  return states;
}

/// 20 trials without field, `learn` in the field with a clamp on every eighth, 20 in the opposite
/// field, 60 in a clamp.
AdaptationSequence schedule(int learn) {
  AdaptationSequence trials(20);
  for (int i = 0; i < learn; ++i) {
    trials.push_back({1.0, i % 8 == 7});
  }
  for (int i = 0; i < 20; ++i) {
    trials.push_back({-1.0, false});
  }
  for (int i = 0; i < 60; ++i) {
    trials.push_back({0.0, true});
  }
  return trials;
}

AdaptationSequence measured(const TwoRateModel& model, AdaptationSequence trials, double noise,
                            RandomStream& random) {
  const auto states = two_rate_states(model, trials);
  for (std::size_t i = 0; i < trials.size(); ++i) {
    trials[i].measured = states[i].measured + (noise > 0.0 ? noise * random.normal() : 0.0);
  }
  return trials;
}

TEST(TwoRateTest, OneProcessAloneHasItsClosedForm) {
  // x(n) = B / (1 - A + B) (1 - (A - B)^n)
  const TwoRateModel model{{0.5, 0.0}, {0.97, 0.08}, 1.0};
  const auto states = two_rate_states(model, AdaptationSequence(50, {1.0, false}));
  for (int n = 0; n < 50; ++n) {
    const double x = 0.08 / (1.0 - 0.97 + 0.08) * (1.0 - std::pow(0.97 - 0.08, n));
    EXPECT_NEAR(states[static_cast<std::size_t>(n)].adaptation(), x, 1e-14);
    EXPECT_NEAR(states[static_cast<std::size_t>(n)].error, 1.0 - x, 1e-14);
  }
}

TEST(TwoRateTest, ClampsForgetWithEachRetention) {
  AdaptationSequence trials(100, {1.0, false});
  trials.insert(trials.end(), 30, {0.0, true});
  const auto states = two_rate_states({}, trials);
  for (std::size_t k = 0; k < 30; ++k) {
    const auto power = static_cast<double>(k);
    EXPECT_NEAR(states[100 + k].fast, states[100].fast * std::pow(0.59, power), 1e-15);
    EXPECT_NEAR(states[100 + k].slow, states[100].slow * std::pow(0.992, power), 1e-15);
    EXPECT_EQ(states[100 + k].error, 0.0);
  }
}

TEST(TwoRateTest, AdaptationRecoversAfterTheOppositeField) {
  // Smith, Ghazizadeh and Shadmehr 2006: counter-learning to about zero, then a rebound in clamps.
  AdaptationSequence trials(300, {1.0, false});
  const auto learned = two_rate_states({}, trials);
  std::size_t counter = 0;
  while (two_rate_states({}, trials).back().adaptation() > 0.0) {
    trials.push_back({-1.0, false});
    ++counter;
  }
  EXPECT_LT(counter, 40u);
  trials.insert(trials.end(), 60, {0.0, true});
  const auto states = two_rate_states({}, trials);
  const auto clamp = states.end() - 60;
  const auto highest = std::max_element(clamp, states.end(), [](const auto& a, const auto& b) {
    return a.adaptation() < b.adaptation();
  });
  EXPECT_GT(highest->adaptation(), 0.15 * learned.back().adaptation());
  EXPECT_GT(highest - clamp, 2);
  EXPECT_LT(states.back().adaptation(), highest->adaptation());
}

TEST(TwoRateTest, ParametersAreFoundAgain) {
  RandomStream random(1, "none");
  for (const TwoRateModel& truth : {TwoRateModel{}, TwoRateModel{{0.8, 0.15}, {0.99, 0.03}, 1.0},
                                    TwoRateModel{{0.4, 0.3}, {0.998, 0.01}, 1.0},
                                    TwoRateModel{{0.9, 0.1}, {0.995, 0.02}, 1.0}}) {
    const std::vector<AdaptationSequence> one{measured(truth, schedule(200), 0.0, random)};
    const auto fit = fit_two_rate(one);
    ASSERT_TRUE(fit) << fit.because();
    EXPECT_NEAR(fit->model.fast.retention, truth.fast.retention, 1e-6);
    EXPECT_NEAR(fit->model.fast.learning, truth.fast.learning, 1e-6);
    EXPECT_NEAR(fit->model.slow.retention, truth.slow.retention, 1e-6);
    EXPECT_NEAR(fit->model.slow.learning, truth.slow.learning, 1e-6);
    EXPECT_EQ(fit->errors.error_scale, 0.0);
  }
}

TEST(TwoRateTest, TheScaleOfTheErrorIsFound) {
  RandomStream random(1, "none");
  const TwoRateModel truth{{0.59, 0.21}, {0.992, 0.02}, -13.5};  // millimetres, to the right
  const std::vector<AdaptationSequence> one{measured(truth, schedule(200), 0.0, random)};
  TwoRateOptions options;
  options.fit_error_scale = true;
  options.start.error_scale = -10.0;
  const auto fit = fit_two_rate(one, options);
  ASSERT_TRUE(fit) << fit.because();
  EXPECT_NEAR(fit->model.error_scale, -13.5, 1e-5);
  EXPECT_NEAR(fit->model.fast.learning, 0.21, 1e-6);
}

TEST(TwoRateTest, TrialsThatWereNotMeasuredStillTeach) {
  RandomStream random(1, "none");
  AdaptationSequence trials = measured({}, schedule(200), 0.0, random);
  for (std::size_t i = 0; i < trials.size(); i += 3) {
    trials[i].measured = std::numeric_limits<double>::quiet_NaN();
  }
  const auto fit = fit_two_rate(std::vector<AdaptationSequence>{trials});
  EXPECT_NEAR(fit->model.fast.retention, 0.59, 1e-6);
  EXPECT_EQ(fit->count, 200u);
}

TEST(TwoRateTest, StandardErrorsAreThoseOfManyFits) {
  constexpr int kFits = 600;
  RandomStream random(17, "noise");
  Eigen::Array4d sum = Eigen::Array4d::Zero(), squares = sum, stated = sum;
  for (int i = 0; i < kFits; ++i) {
    const std::vector<AdaptationSequence> one{measured({}, schedule(200), 0.02, random)};
    const auto fit = fit_two_rate(one);
    ASSERT_TRUE(fit) << fit.because();
    const TwoRateModel &m = fit->model, &e = fit->errors;
    const Eigen::Array4d at(m.fast.retention, m.fast.learning, m.slow.retention, m.slow.learning);
    sum += at / kFits;
    squares += at.square() / kFits;
    stated += Eigen::Array4d(e.fast.retention, e.fast.learning, e.slow.retention, e.slow.learning) /
              kFits;
  }
  const Eigen::Array4d real = (squares - sum.square()).sqrt();
  for (int k = 0; k < 4; ++k) {
    // A standard deviation of 600 values is known to 2.9 %.
    EXPECT_NEAR(stated[k] / real[k], 1.0, 0.1) << k;
  }
}

TEST(TwoRateTest, IntervalsHoldTheTruth) {
  constexpr int kStudies = 300;
  constexpr std::size_t kPeople = 12;
  std::array<int, 4> held{};
  for (int study = 0; study < kStudies; ++study) {
    RandomStream random(static_cast<std::uint64_t>(study), "people with two rates");
    std::vector<AdaptationSequence> people;
    for (std::size_t p = 0; p < kPeople; ++p) {
      people.push_back(measured({}, schedule(120), 0.1, random));
    }
    const auto fit = fit_two_rate_learning(
        people, {}, {{static_cast<std::uint64_t>(study), "coverage", 999, 1}, 0.95});
    ASSERT_TRUE(fit) << fit.because();
    const auto holds = [](const Defined<BootstrapInterval>& i, double truth) {
      return i && i->low <= truth && truth <= i->high ? 1 : 0;
    };
    held[0] += holds(fit->fast_retention, 0.59);
    held[1] += holds(fit->fast_learning, 0.21);
    held[2] += holds(fit->slow_retention, 0.992);
    held[3] += holds(fit->slow_learning, 0.02);
  }
  for (std::size_t k = 0; k < held.size(); ++k) {
    RecordProperty("held_" + std::to_string(k), held[k]);
    EXPECT_NEAR(held[k], 0.95 * kStudies, 3.3 * std::sqrt(0.95 * 0.05 * kStudies));  // binomial
  }
}

TEST(TwoRateTest, WhatCannotBeFittedIsSaid) {
  RandomStream random(1, "none");
  const std::vector<AdaptationSequence> few{AdaptationSequence(5, {1.0, false, 0.5})};
  EXPECT_FALSE(fit_two_rate(few));
  // Nothing is ever learned without a perturbation.
  const std::vector<AdaptationSequence> still{
      measured({}, AdaptationSequence(100, {0.0, false}), 0.1, random)};
  EXPECT_FALSE(fit_two_rate(still));
  const std::vector<AdaptationSequence> broken{
      AdaptationSequence(100, {std::numeric_limits<double>::infinity(), false, 0.5})};
  EXPECT_FALSE(fit_two_rate(broken));
}

}  // namespace
}  // namespace haptrial::analysis
