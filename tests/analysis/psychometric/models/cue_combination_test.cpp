#include "analysis/psychometric/models/cue_combination.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/base/random.h"
#include "tests/support/null_levels.h"

namespace haptrial::analysis::cue_combination_test {
namespace {

TEST(CueCombinationTest, ThePredictedWeightGivesTheLeastVariance) {
  for (const auto& [a, b] : {std::pair{0.4, 1.1}, {2.0, 2.0}, {3.0, 0.5}}) {
    const CombinedCues cues = predict_combination({a, 0.0}, {b, 0.0});
    const auto variance = [a = a, b = b](double w) {
      return w * w * a * a + (1.0 - w) * (1.0 - w) * b * b;
    };
    const double w = cues.first_weight.value;
    EXPECT_NEAR(cues.combined_sd.value, std::sqrt(variance(w)), 1e-14);
    EXPECT_LT(variance(w), variance(w + 1e-3));
    EXPECT_LT(variance(w), variance(w - 1e-3));
    EXPECT_LT(cues.combined_sd.value, std::min(a, b));
    const CombinedCues swapped = predict_combination({b, 0.0}, {a, 0.0});
    EXPECT_NEAR(swapped.first_weight.value, 1.0 - w, 1e-14);
  }
}

TEST(CueCombinationTest, EqualCuesShareAndGainTheRootOfTwo) {
  const CombinedCues cues = predict_combination({3.0, 0.1}, {3.0, 0.1});
  EXPECT_NEAR(cues.first_weight.value, 0.5, 1e-15);
  EXPECT_NEAR(cues.combined_sd.value, 3.0 / std::sqrt(2.0), 1e-14);
  EXPECT_LT(cues.first_weight.low, 0.5);
  EXPECT_GT(cues.first_weight.high, 0.5);
}

TEST(CueCombinationTest, IntervalsHoldTheTruth) {
  constexpr int kStudies = 4000;
  RandomStream random(3, "cues");
  int weight = 0, sd = 0;
  const double a = 1.0, b = 1.7;
  const CombinedCues truth = predict_combination({a, 0.0}, {b, 0.0});
  const auto holds = [](const CuePrediction& p, double value) {
    return p.low <= value && value <= p.high ? 1 : 0;
  };
  for (int i = 0; i < kStudies; ++i) {
    // Estimates with a relative error of 10 %, lognormal as standard deviations nearly are.
    const double one = a * std::exp(0.1 * random.normal());
    const double two = b * std::exp(0.1 * random.normal());
    const CombinedCues cues = predict_combination({one, 0.1 * one}, {two, 0.1 * two});
    weight += holds(cues.first_weight, truth.first_weight.value);
    sd += holds(cues.combined_sd, truth.combined_sd.value);
  }
  const double bound = 3.3 * std::sqrt(0.95 * 0.05 * kStudies);
  RecordProperty("weight", weight);
  RecordProperty("sd", sd);
  EXPECT_NEAR(weight, 0.95 * kStudies, bound);
  EXPECT_NEAR(sd, 0.95 * kStudies, bound);
}

TEST(CueCombinationTest, TheObservedWeightIsTheSlopeOverConflicts) {
  std::vector<ConflictPse> conflicts;
  for (const double conflict : {-6.0, -3.0, 0.0, 3.0, 6.0}) {  // Ernst and Banks's, in mm
    const double first = 55.0 + 0.5 * conflict, second = 55.0 - 0.5 * conflict;
    conflicts.push_back({first, second, {0.7 * first + 0.3 * second + 0.4, 0.5}});
  }
  const auto observed = observed_weight(conflicts);
  EXPECT_NEAR(observed->first_weight.value, 0.7, 1e-13);
  EXPECT_NEAR(observed->bias, 0.4, 1e-12);
  EXPECT_NEAR(observed->chi_squared, 0.0, 1e-20);
  EXPECT_EQ(observed->df, 3u);
  // The error of a slope of five values with error 0.5 at -6 .. 6: 0.5 / sqrt(90).
  EXPECT_NEAR(observed->first_weight.error, 0.5 / std::sqrt(90.0), 1e-14);
}

TEST(CueCombinationTest, APreciseValueWeighsMore) {
  const std::vector<ConflictPse> conflicts{
      {0.0, 0.0, {0.0, 0.001}}, {1.0, 0.0, {0.5, 0.001}}, {2.0, 0.0, {9.0, 100.0}}};
  EXPECT_NEAR(observed_weight(conflicts)->first_weight.value, 0.5, 1e-6);
}

struct People {
  std::vector<CueParticipant> all;
};

/// Optimal observers whose estimates have relative errors of 10 %; `first_only` ignore the second
/// cue.
People observers(RandomStream& random, std::size_t count, bool first_only) {
  People people;
  for (std::size_t p = 0; p < count; ++p) {
    const double a = std::exp(0.3 * random.normal()), b = 1.3 * std::exp(0.3 * random.normal());
    const CombinedCues truth = predict_combination({a, 0.0}, {b, 0.0});
    const auto noisy = [&](double sd) { return sd * std::exp(0.1 * random.normal()); };
    people.all.push_back({noisy(a), noisy(b), noisy(first_only ? a : truth.combined_sd.value),
                          (first_only ? 1.0 : truth.first_weight.value) + 0.1 * random.normal()});
  }
  return people;
}

TEST(CueCombinationTest, OptimalObserversDifferInFivePercentOfStudies) {
  constexpr std::size_t kStudies = 2000;
  std::size_t weight = 0, sd = 0;
  for (std::size_t study = 0; study < kStudies; ++study) {
    RandomStream random(study, "optimal observers");
    const CueComparison c = compare_cues(observers(random, 12, false).all);
    weight += c.weight->p < 0.05 ? 1 : 0;
    sd += c.log_sd->p < 0.05 ? 1 : 0;
  }
  RecordProperty("weight", static_cast<int>(weight));
  RecordProperty("log_sd", static_cast<int>(sd));
  const test::Band band = test::binomial_band(kStudies, 0.999);
  EXPECT_GE(weight, band.low);
  EXPECT_LE(weight, band.high);
  EXPECT_GE(sd, band.low);
  EXPECT_LE(sd, band.high);
}

TEST(CueCombinationTest, ObserversWhoIgnoreACueAreFound) {
  RandomStream random(2, "observers of one cue");
  const CueComparison c = compare_cues(observers(random, 12, true).all);
  EXPECT_LT(c.weight->p, 1e-4);
  EXPECT_GT(c.weight->difference, 0.0);
  EXPECT_LT(c.log_sd->p, 1e-3);
  EXPECT_GT(c.beats_best->p, 0.05);
  RandomStream again(2, "observers of both cues");
  const CueComparison both = compare_cues(observers(again, 12, false).all);
  EXPECT_LT(both.beats_best->p, 0.01);
  EXPECT_GT(both.weights->r, 0.5);
}

TEST(CueCombinationTest, WhatIsNotDefinedIsSaid) {
  EXPECT_THROW(predict_combination({0.0, 0.1}, {1.0, 0.1}), std::invalid_argument);
  EXPECT_THROW(predict_combination({1.0, -0.1}, {1.0, 0.1}), std::invalid_argument);
  EXPECT_THROW(predict_combination({1.0, 0.1}, {1.0, 0.1}, 1.0), std::invalid_argument);
  const ConflictPse one{55.0, 54.0, {54.5, 0.3}};
  EXPECT_FALSE(observed_weight(std::vector{one}));
  EXPECT_FALSE(observed_weight(std::vector{one, one}));
  EXPECT_THROW(observed_weight(std::vector{ConflictPse{1.0, 2.0, {1.5, 0.0}}}),
               std::invalid_argument);
  EXPECT_FALSE(compare_cues({}).weight);
  EXPECT_THROW(compare_cues(std::vector<CueParticipant>(1)), std::invalid_argument);
}

}  // namespace
}  // namespace haptrial::analysis::cue_combination_test
