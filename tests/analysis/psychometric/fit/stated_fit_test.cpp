#include "analysis/psychometric/fit/stated_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "analysis/psychometric/fit/adaptive_posterior.h"
#include "core/base/random.h"
#include "core/psychometric/procedure/staircase.h"

namespace haptrial::analysis {
namespace {

LikelihoodOptions stated_options(Task task) {
  LikelihoodOptions options{.task = task};
  options.function.sigmoid = psychometric::Sigmoid::kGaussian;
  options.lapse.high = 0.2;
  options.guess.high = kLargestRate;
  return options;
}

/// Yes/no with 300 false alarms in 1,000 catch trials; far above the threshold all is felt.
const std::vector<TrialBlock> kCatches{{kNoStimulus, 300, 1000},
                                       {-2.0, 6, 20},
                                       {-1.0, 7, 20},
                                       {0.0, 13, 20},
                                       {1.0, 19, 20},
                                       {3.0, 40, 40}};

TEST(StatedFit, CatchTrialsTellTheGuessRate) {
  const StatedFit with = stated_fit(kCatches, stated_options(Task::kYesNo), false, 1.0);
  EXPECT_NEAR(with.estimate.guess, 0.3, 0.02);
  EXPECT_FALSE(with.guess_at_bound);
  const StatedFit adaptive = stated_fit(kCatches, stated_options(Task::kYesNo), true, 1.0);
  EXPECT_NEAR(adaptive.estimate.guess, 0.3, 0.02);
  // A low bound is marked, and the answers speak against it.
  LikelihoodOptions low = stated_options(Task::kYesNo);
  low.guess.high = 0.06;
  const StatedFit bounded = stated_fit(kCatches, low, false, 1.0);
  EXPECT_TRUE(bounded.guess_at_bound);
  EXPECT_EQ(bounded.no_interval, "there are more guesses than the bound of 0.06 allows");
}

TEST(StatedFit, AFallingFunctionHasTheSameCatchTrials) {
  std::vector<TrialBlock> mirrored = kCatches;
  for (TrialBlock& block : mirrored) {
    block.level = block.level == kNoStimulus ? kNoStimulus : -block.level;
  }
  LikelihoodOptions falls = stated_options(Task::kYesNo);
  falls.function.falling = true;
  const StatedFit a = stated_fit(kCatches, stated_options(Task::kYesNo), false, 1.0);
  const StatedFit b = stated_fit(mirrored, falls, false, 1.0);
  EXPECT_NEAR(a.estimate.threshold, -b.estimate.threshold, 1e-6);
  EXPECT_NEAR(a.estimate.guess, b.estimate.guess, 1e-6);
  EXPECT_NEAR(a.threshold.high, -b.threshold.low, 1e-4);
}

// Single tracks hardly tell a width: the likeliest one often lies outside of what is probable.
TEST(StatedFit, AnAdaptiveEstimateLiesWithinItsInterval) {
  psychometric::StaircaseParameters rule;
  rule.start = 2.0;
  rule.low = -3.0;
  rule.high = 3.0;
  rule.steps = {{0.5, 0.5, 0}};
  rule.stop_reversals = 8;
  rule.stop_trials = 100;
  LikelihoodOptions options = stated_options(Task::kForcedChoice);
  options.presentable = SearchBounds{-3.0, 3.0};
  int outside = 0;
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    RandomStream random(seed, "answers");
    psychometric::Staircase track(rule);
    std::vector<TrialBlock> blocks;
    while (!track.finished()) {
      const psychometric::Level level = track.next();
      const double p = 0.5 + 0.48 / (1.0 + std::exp(-2.0 * level[0]));
      const int answer = random.uniform() < p ? 1 : 0;
      blocks.push_back({level[0], answer, 1});
      track.report(answer, level);
    }
    const StatedFit fit = stated_fit(pooled(blocks), options, true, 1.0);
    EXPECT_TRUE(fit.threshold.holds(fit.estimate.threshold)) << seed;
    EXPECT_TRUE(fit.width.holds(fit.estimate.width)) << seed;
    EXPECT_TRUE(fit.lapse.holds(fit.estimate.lapse)) << seed;
    outside += fit.width.holds(fit.likeliest.parameters.width) ? 0 : 1;
  }
  EXPECT_GT(outside, 0) << "the likelihood's estimate would do";
}

// At the easiest level that there is every second answer is wrong.
TEST(StatedFit, AThresholdBeyondWhatCouldBePresentedIsOpen) {
  LikelihoodOptions options = stated_options(Task::kForcedChoice);
  options.presentable = SearchBounds{305.0, 325.0};
  const std::vector<TrialBlock> blocks{{315.0, 3, 6}, {320.0, 5, 10}, {325.0, 32, 60}};
  const StatedFit fit = stated_fit(blocks, options, true, 1.0);
  EXPECT_TRUE(fit.threshold.high_open);
  EXPECT_FALSE(fit.threshold.low_open);
  EXPECT_TRUE(fit.threshold.holds(348.4));
}

TEST(StatedFit, MoreLapsesThanAllowedLeaveNoInterval) {
  LikelihoodOptions options = stated_options(Task::kForcedChoice);
  options.lapse.high = 0.06;
  const std::vector<TrialBlock> lapsing{
      {-1.0, 20, 40}, {0.0, 28, 40}, {1.0, 33, 40}, {3.0, 33, 40}, {4.0, 33, 40}};
  const StatedFit fit = stated_fit(lapsing, options, false, 1.0);
  EXPECT_TRUE(fit.lapse_at_bound);
  EXPECT_EQ(fit.no_interval, "there are more lapses than the bound of 0.06 allows");
  options.lapse.high = 0.3;
  EXPECT_TRUE(stated_fit(lapsing, options, false, 1.0).no_interval.empty());
}

TEST(StatedFit, ScatterBeyondChanceMakesIntervalsLonger) {
  const LikelihoodOptions options = stated_options(Task::kForcedChoice);
  const std::vector<TrialBlock> blocks{{-2.0, 14, 40}, {-1.0, 29, 40}, {-0.5, 18, 40},
                                       {0.0, 35, 40},  {0.5, 25, 40},  {1.0, 39, 40},
                                       {2.0, 36, 40}};
  const StatedFit chance = stated_fit(blocks, options, false, 0.5);
  const StatedFit scattered = stated_fit(blocks, options, false, 0.01);
  EXPECT_EQ(chance.widening, 1.0);
  EXPECT_GT(scattered.widening, 1.2);
  EXPECT_LT(scattered.threshold.low, chance.threshold.low);
  EXPECT_GT(scattered.threshold.high, chance.threshold.high);
  EXPECT_EQ(scattered.estimate.threshold, chance.estimate.threshold);
}

/// Chi-square of four degrees of freedom, seven levels less three parameters, in closed form.
TEST(StatedFit, WithoutSamplesChiSquareJudgesTheScatter) {
  EXPECT_TRUE(std::isnan(StatedFit{}.deviance_p)) << "nothing is judged before a fit";
  constexpr double kNoSamples = std::numeric_limits<double>::quiet_NaN();
  const LikelihoodOptions options = stated_options(Task::kForcedChoice);
  std::vector<TrialBlock> blocks{{-2.0, 14, 40}, {-1.0, 29, 40}, {-0.5, 18, 40}, {0.0, 35, 40},
                                 {0.5, 25, 40},  {1.0, 39, 40},  {2.0, 36, 40}};
  const StatedFit scattered = stated_fit(blocks, options, false, kNoSamples);
  const double half =
      0.5 * deviance_of(fitted_function(options.function, scattered.likeliest.parameters), blocks)
                .deviance;
  EXPECT_NEAR(scattered.deviance_p, std::exp(-half) * (1.0 + half), 1e-9);
  EXPECT_EQ(scattered.widening, stated_fit(blocks, options, false, 0.01).widening);
  blocks = {{-2.0, 21, 40}, {-1.0, 22, 40}, {-0.5, 26, 40}, {0.0, 30, 40},
            {0.5, 34, 40},  {1.0, 37, 40},  {2.0, 39, 40}};
  const StatedFit smooth = stated_fit(blocks, options, false, kNoSamples);
  EXPECT_GT(smooth.deviance_p, kUnusualScatter);
  EXPECT_EQ(smooth.widening, 1.0);
  for (TrialBlock& block : blocks) {
    block = {block.level, block.correct / 10, 4};
  }
  const auto judged = [&] {
    return !std::isnan(stated_fit(blocks, options, false, kNoSamples).deviance_p);
  };
  EXPECT_FALSE(judged()) << "too few trials at a level";
  blocks[3] = {0.0, 9, 11};  // 35 trials of seven levels
  EXPECT_TRUE(judged());
}

}  // namespace
}  // namespace haptrial::analysis
