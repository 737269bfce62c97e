#include "analysis/psychometric/fit/profile_interval.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "analysis/statistics/base/solvers.h"
#include "core/base/random.h"
#include "tests/support/allocation_guard.h"

namespace haptrial::analysis::profile_interval_test {
namespace {

using psychometric::parameters_named;
using psychometric::PsychometricFunction;

constexpr double kCut = 3.841458820694124;  // 95 % of chi-square with one degree of freedom

std::vector<TrialBlock> drawn(RandomStream& random, const PsychometricFunction& observer) {
  std::vector<TrialBlock> blocks;
  for (int i = 0; i < 8; ++i) {
    TrialBlock block{1.4 + 1.2 * i / 7.0, 0, 40};
    for (int t = 0; t < block.total; ++t) {
      block.correct += random.uniform() < observer(block.level) ? 1 : 0;
    }
    blocks.push_back(block);
  }
  return blocks;
}

double log_likelihood(const PsychometricFunction& function, const std::vector<TrialBlock>& blocks) {
  double sum = 0.0;
  for (const TrialBlock& b : blocks) {
    const double p = function(b.level);
    sum += (b.correct > 0 ? b.correct * std::log(p) : 0.0) +
           (b.total > b.correct ? (b.total - b.correct) * std::log1p(-p) : 0.0);
  }
  return sum;
}

/// The largest log-likelihood with a threshold or a width held, by a search without derivatives.
double profile(const LikelihoodOptions& options, const std::vector<TrialBlock>& blocks, Held held,
               double value, const FittedParameters& from) {
  const double spacing = 1.2 / 7.0;  // the width's lower bound
  const auto minus = [&](std::span<const double> x) {
    FittedParameters p{value, value, 0.03 - 0.03 * std::cos(x[1]), 0.5};
    if (held == Held::kThreshold) {
      p.width = spacing + std::exp(x[0]);
    } else {
      p.threshold = x[0];
    }
    return -log_likelihood(fitted_function(options.function, p), blocks);
  };
  const double start =
      held == Held::kThreshold ? std::log(std::max(from.width - spacing, 0.05)) : from.threshold;
  return -find_minimum(minus, std::vector{start, 1.5}, std::vector{0.2, 0.5}).value;
}

// The definition, by another search: at each end the likelihood has fallen by the cut.
TEST(ProfileInterval, EndsWhereTheLikelihoodRatioIsTheCut) {
  RandomStream random(2, "profile interval");
  const LikelihoodOptions options{.function = parameters_named("norm", 0.5)};
  const auto observer = fitted_function(options.function, {2.0, 1.0, 0.02, 0.5});
  int ends = 0;
  for (int run = 0; run < 40; ++run) {
    const auto blocks = drawn(random, observer);
    const ProfiledFit found = profiled_fit(blocks, options);
    const auto check = [&](Held held, double value, bool open) {
      if (!open) {
        const double there = profile(options, blocks, held, value, found.fit.parameters);
        EXPECT_NEAR(2.0 * (found.fit.log_likelihood - there), kCut, 1e-3) << run << " " << value;
        ++ends;
      }
    };
    check(Held::kThreshold, found.threshold.low, found.threshold.low_open);
    check(Held::kThreshold, found.threshold.high, found.threshold.high_open);
    check(Held::kWidth, found.width.low, found.width.low_open);
    check(Held::kWidth, found.width.high, found.width.high_open);
    EXPECT_TRUE(found.threshold.holds(found.fit.parameters.threshold)) << run;
    EXPECT_TRUE(found.width.holds(found.fit.parameters.width)) << run;
  }
  EXPECT_GT(ends, 130);  // of 160; some widths have no lower end
}

// Many trials without lapses: 1.96 standard errors of Fisher's information, in closed form.
TEST(ProfileInterval, OfAWideSampleIsThatOfFishersInformation) {
  LikelihoodOptions options{.function = parameters_named("norm"), .task = Task::kYesNo};
  options.lapse = options.guess = {0.0, 0.0};
  const PsychometricFunction truth = fitted_function(options.function, {2.2, 2.0});
  const double rise = psychometric::rate_of_width(options.function.sigmoid, 2.0);
  std::vector<TrialBlock> blocks;
  double a = 0.0, b = 0.0, c = 0.0;  // information of intercept and slope of z = rise (x - 2.2)
  constexpr int kTrials = 1000000;
  for (int i = 0; i < 8; ++i) {
    const double x = 0.5 + 0.5 * i, p = truth(x), z = rise * (x - 2.2);
    blocks.push_back({x, static_cast<int>(std::lround(kTrials * p)), kTrials});
    const double density = std::exp(-0.5 * z * z) / std::sqrt(2.0 * M_PI);
    const double weight = kTrials * density * density / (p * (1.0 - p));
    a += weight, b += weight * (x - 2.2), c += weight * (x - 2.2) * (x - 2.2);
  }
  const double determinant = a * c - b * b;
  const double threshold_error = std::sqrt(c / determinant) / rise;
  const double width_error = 2.0 * std::sqrt(a / determinant) / rise;
  const ProfiledFit found = profiled_fit(blocks, options);
  const double both = 2.0 * std::sqrt(kCut);
  EXPECT_NEAR(found.threshold.high - found.threshold.low, both * threshold_error,
              1e-3 * both * threshold_error);
  EXPECT_NEAR(found.width.high - found.width.low, both * width_error, 1e-3 * both * width_error);
}

TEST(ProfileInterval, SaysWhichSideIsOpen) {
  LikelihoodOptions options{.function = parameters_named("norm"), .task = Task::kYesNo};
  const std::vector<TrialBlock> stepped{{1, 0, 20}, {2, 0, 20}, {3, 20, 20}, {4, 20, 20}};
  const ProfiledFit step = profiled_fit(stepped, options);
  EXPECT_TRUE(step.width.low_open);
  EXPECT_EQ(step.width.low, 0.0);
  EXPECT_FALSE(step.width.high_open);
  EXPECT_FALSE(step.threshold.low_open || step.threshold.high_open);
  EXPECT_GT(step.threshold.low, 2.0);
  EXPECT_LT(step.threshold.low, 2.5);
  EXPECT_NEAR(step.threshold.low + step.threshold.high, 5.0, 1e-5);  // answers are symmetric
  const std::vector<TrialBlock> all{{1, 20, 20}, {2, 20, 20}, {3, 20, 20}};
  const ProfiledFit easy = profiled_fit(all, options);
  EXPECT_TRUE(easy.threshold.low_open);
  EXPECT_FALSE(easy.threshold.high_open);
  EXPECT_LT(easy.threshold.high, 1.5);
  EXPECT_TRUE(easy.fit.undetermined);
}

// Answers to single trials can have a flat and a steep maximum: the fit is not behind the better.
TEST(ProfileInterval, TakesTheLikeliestOfSeveralMaxima) {
  RandomStream random(4, "profile interval");
  const LikelihoodOptions options{.function = parameters_named("norm", 0.5)};
  const auto observer = fitted_function(options.function, {2.0, 3.0, 0.02, 0.5});
  int several = 0;
  for (int run = 0; run < 200; ++run) {
    std::vector<TrialBlock> blocks;
    for (int i = 0; i < 16; ++i) {
      TrialBlock block{0.25 * i, 0, 3};
      for (int t = 0; t < 3; ++t) {
        block.correct += random.uniform() < observer(block.level) ? 1 : 0;
      }
      blocks.push_back(block);
    }
    const double found = profiled_fit(blocks, options).fit.log_likelihood;
    const LikelihoodFit plain = likelihood_fit(blocks, options);
    EXPECT_GE(found, plain.log_likelihood - 1e-9);
    several += found > plain.log_likelihood + 1e-4 ? 1 : 0;
  }
  EXPECT_GT(several, 0);
}

TEST(ProfileInterval, OfAHigherLevelHoldsThatOfALower) {
  RandomStream random(3, "profile interval");
  const LikelihoodOptions options{.function = parameters_named("norm", 0.5)};
  const auto observer = fitted_function(options.function, {2.0, 1.0, 0.02, 0.5});
  const auto blocks = drawn(random, observer);
  const ProfiledFit narrow = profiled_fit(blocks, options, 0.68);
  const ProfiledFit wide = profiled_fit(blocks, options, 0.95);
  EXPECT_LT(wide.threshold.low, narrow.threshold.low);
  EXPECT_GT(wide.threshold.high, narrow.threshold.high);
  for (const double level : {0.0, 1.0, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THROW(profiled_fit(blocks, options, level), std::invalid_argument);
  }
}

TEST(ProfileInterval, DoesNotAllocate) {
  RandomStream random(5, "profile interval");
  const LikelihoodOptions options{.function = parameters_named("norm", 0.5)};
  const auto blocks = drawn(random, fitted_function(options.function, {2.0, 1.0, 0.02, 0.5}));
  const LikelihoodFitter fitter(options, blocks);
  std::vector<int> correct;
  for (const TrialBlock& b : blocks) {
    correct.push_back(b.correct);
  }
  const test::AllocationGuard guard;
  const ProfiledFit found = profiled_fit(fitter, correct);
  EXPECT_EQ(guard.count(), 0u);
  EXPECT_TRUE(found.fit.converged);
}

}  // namespace
}  // namespace haptrial::analysis::profile_interval_test
