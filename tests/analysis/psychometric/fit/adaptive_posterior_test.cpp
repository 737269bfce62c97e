// The posterior of adaptive trials against draws from its prior, and the interval of a track's own
// estimate against the exact chain of a staircase.
#include "analysis/psychometric/fit/adaptive_posterior.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "analysis/psychometric/fit/track_interval.h"
#include "core/base/random.h"
#include "core/psychometric/procedure/staircase.h"
#include "core/psychometric/procedure/staircase_chain.h"

namespace haptrial::analysis::adaptive_test {
namespace {

using psychometric::Staircase;
using psychometric::StaircaseParameters;

struct Weighted {
  double value, weight;
};

double quantile_of(std::vector<Weighted> all, double share) {
  std::sort(all.begin(), all.end(), [](auto& a, auto& b) { return a.value < b.value; });
  double sum = 0.0, below = 0.0;
  for (const Weighted& each : all) {
    sum += each.weight;
  }
  for (const Weighted& each : all) {
    below += each.weight;
    if (below >= share * sum) {
      return each.value;
    }
  }
  return all.back().value;
}

double cosine(double part) {
  return 0.5 + 0.5 * std::cos(std::numbers::pi * std::clamp(part, 0.0, 1.0));
}

/// Threshold and width of functions drawn from the stated prior, weighed by the likelihood.
void draw_prior(const std::vector<TrialBlock>& blocks, const LikelihoodOptions& options,
                std::vector<Weighted>& thresholds, std::vector<Weighted>& widths) {
  const double low = blocks.front().level, high = blocks.back().level, s = high - low, d = 0.5;
  RandomStream random(3, "prior");
  for (int i = 0; i < 150'000; ++i) {
    psychometric::PsychometricParameters p = options.function;
    p.threshold = low - 0.5 * s + 2.0 * s * random.uniform();
    const double w = p.width = d + (3.0 * s - d) * random.uniform();
    p.lapse = 0.06 * random.uniform();
    p.guess = options.task == Task::kYesNo ? 0.06 * random.uniform() : p.guess;
    const psychometric::PsychometricFunction function(p);
    double weight = (1.0 - cosine((w - d) / d)) * cosine((w - s) / (2.0 * s)) / (w + 0.1 * s);
    weight *= std::pow(1.0 - p.lapse, 9.0);
    for (const TrialBlock& b : blocks) {
      const double share = function(b.level);
      weight *= std::pow(share, b.correct) * std::pow(1.0 - share, b.total - b.correct);
    }
    thresholds.push_back({p.threshold, weight});
    widths.push_back({w, weight});
  }
}

TEST(AdaptivePosterior, IsThatOfTheStatedPrior) {
  const std::vector<TrialBlock> blocks{{-1.0, 3, 6}, {-0.5, 6, 10}, {0.0, 8, 13},
                                       {0.5, 7, 8},  {1.0, 4, 4},   {2.0, 2, 2}};
  for (const Task task : {Task::kForcedChoice, Task::kYesNo}) {
    LikelihoodOptions options;
    options.task = task;
    options.function.sigmoid = psychometric::Sigmoid::kGaussian;
    const AdaptivePosterior found = adaptive_posterior(blocks, options, 0.95, 999);
    std::vector<Weighted> thresholds, widths;
    draw_prior(blocks, options, thresholds, widths);
    for (const auto& [end, share] :
         {std::pair(found.threshold.low, 0.025), std::pair(found.threshold.high, 0.975)}) {
      EXPECT_NEAR(end, quantile_of(thresholds, share), 0.08);
    }
    EXPECT_NEAR(std::log(found.width.low / quantile_of(widths, 0.025)), 0.0, 0.06);
    EXPECT_NEAR(std::log(found.width.high / quantile_of(widths, 0.975)), 0.0, 0.04);
    EXPECT_NEAR(found.median.threshold, quantile_of(thresholds, 0.5), 0.05);
    EXPECT_NEAR(std::log(found.median.width / quantile_of(widths, 0.5)), 0.0, 0.05);
    ASSERT_EQ(found.draws.size(), 999U);
    std::vector<Weighted> drawn;
    for (const FittedParameters& draw : found.draws) {
      drawn.push_back({draw.threshold, 1.0});
    }
    EXPECT_NEAR(quantile_of(drawn, 0.025), found.threshold.low, 0.1);
    EXPECT_NEAR(quantile_of(drawn, 0.975), found.threshold.high, 0.1);
  }
}

TEST(AdaptivePosterior, RefusesALevelThatIsNone) {
  const std::vector<TrialBlock> blocks{{0.0, 1, 2}, {1.0, 2, 2}};
  EXPECT_THROW(adaptive_posterior(blocks, {}, 1.0), std::invalid_argument);
}

StaircaseParameters rule() {
  StaircaseParameters p;
  p.start = 2.0;
  p.low = -6.0;
  p.high = 6.0;
  p.down = 2;
  p.steps = {{0.5, 0.5, 0}};
  p.stop_reversals = 10;
  p.stop_trials = 200;
  p.skip = 2;
  return p;
}

// If the function is known, the errors of tracks are those of the exact chain. A mean of levels has
// no deviation of its own.
TEST(TrackInterval, OfAKnownFunctionIsThatOfTheExactChain) {
  StaircaseParameters p = rule();
  p.estimator = StaircaseParameters::Estimator::kMeanOfLevels;
  p.stop_reversals = 0;
  p.start = 5.0;  // so far off that the bias is larger than the scatter
  p.stop_trials = 60;
  p.skip = 0;
  psychometric::PsychometricParameters f{
      .threshold = 0.2, .width = 4.0, .guess = 0.5, .lapse = 0.01};
  f.sigmoid = psychometric::Sigmoid::kGaussian;
  const psychometric::PsychometricFunction psi(f);
  const double target = psi.level_for(psychometric::balance_of(2, p.steps[0]));
  const auto chain = psychometric::predict_staircase(
      p, [&psi](double x) { return psi.at(x); }, target);
  const std::vector<FittedParameters> draws(3000, {f.threshold, f.width, f.lapse, f.guess, 0.0});
  const FinishedTrack track{
      {"", 0.7, {}}, 50, true, [&p] { return std::make_unique<Staircase>(p); }};
  const auto found = track_interval(track, f, draws, 5);
  ASSERT_TRUE(found) << found.because();
  ASSERT_GT(chain.bias, chain.deviation);
  EXPECT_NEAR(0.5 * (found->low + found->high), 0.7 - chain.bias, 0.3 * chain.deviation);
  EXPECT_NEAR(0.5 * (found->high - found->low), 1.96 * chain.deviation, 0.1 * chain.deviation);
}

// With a deviation, a track that scattered more has a longer interval than one that scattered less.
TEST(TrackInterval, FollowsTheScatterOfTheTrack) {
  const StaircaseParameters p = rule();
  psychometric::PsychometricParameters f{.guess = 0.5};
  f.sigmoid = psychometric::Sigmoid::kGaussian;
  const std::vector<FittedParameters> draws(400, {0.2, 4.0, 0.01, 0.5, 0.0});
  const auto length = [&](double deviation) {
    const auto found = track_interval(
        {{"", 0.7, deviation}, 50, true, [&p] { return std::make_unique<Staircase>(p); }}, f, draws,
        5);
    return found->high - found->low;
  };
  EXPECT_GT(length(0.4), 1.1 * length(0.1));
}

TEST(TrackInterval, IsNotDefinedWithoutALevelThatIsSought) {
  StaircaseParameters p = rule();
  p.up = 2;
  const std::vector<FittedParameters> draws(200, {0.0, 4.0, 0.01, 0.5, 0.0});
  psychometric::PsychometricParameters f{.guess = 0.5};
  const auto of = [&f, &draws](const StaircaseParameters& rule) {
    return track_interval(
        {{"", 0.7, {}}, 50, true, [&rule] { return std::make_unique<Staircase>(rule); }}, f, draws,
        5);
  };
  EXPECT_EQ(of(p).because(), "the procedure seeks no level of a known probability");
  p = rule();
  p.stop_trials = 2;  // no track has a reversal by then
  EXPECT_EQ(of(p).because(), "too few simulated tracks of such observers have an estimate");
}

}  // namespace
}  // namespace haptrial::analysis::adaptive_test
