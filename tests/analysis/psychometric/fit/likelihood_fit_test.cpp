#include "analysis/psychometric/fit/likelihood_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>

#include "analysis/psychometric/fit/bootstrap_fit.h"
#include "analysis/statistics/base/solvers.h"
#include "core/base/random.h"
#include "tests/support/allocation_guard.h"

namespace haptrial::analysis::likelihood_fit_test {
namespace {

using psychometric::parameters_named;
using psychometric::PsychometricFunction;

/// Eight levels, `trials` each, from an observer.
std::vector<TrialBlock> answers(RandomStream& random, const PsychometricFunction& observer,
                                int trials) {
  std::vector<TrialBlock> blocks;
  for (int i = 0; i < 8; ++i) {
    TrialBlock block{0.5 + 0.5 * i, 0, trials};
    for (int t = 0; t < trials; ++t) {
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

struct Kind {
  const char* sigmoid;
  Task task;
};

class LikelihoodFitKinds : public testing::TestWithParam<Kind> {
 protected:
  LikelihoodOptions options() const {
    return {.function = parameters_named(GetParam().sigmoid, 0.5), .task = GetParam().task};
  }
  PsychometricFunction observer() const {
    const bool logarithmic = options().function.axis.scale != psychometric::Scale::kLinear;
    const double guess = GetParam().task == Task::kForcedChoice ? 0.5 : 0.03;
    return fitted_function(options().function,
                           {logarithmic ? 0.8 : 2.2, logarithmic ? 1.0 : 2.0, 0.03, guess});
  }
};

// A search without derivatives, from the truth, finds nothing likelier within the same bounds.
TEST_P(LikelihoodFitKinds, NoOtherSearchFindsALikelierFunction) {
  RandomStream random(7, std::string("likelihood fit ") + GetParam().sigmoid);
  const LikelihoodOptions o = options();
  const psychometric::Axis& axis = o.function.axis;
  const double spacing = axis.at(4.0) - axis.at(3.5);  // the width's lower bound
  int determined = 0;
  for (int run = 0; run < 60; ++run) {
    const auto blocks = answers(random, observer(), 40);
    const LikelihoodFit fit = likelihood_fit(blocks, o);
    EXPECT_TRUE(fit.converged) << run;
    EXPECT_NEAR(fit.log_likelihood,
                log_likelihood(fitted_function(o.function, fit.parameters), blocks),
                1e-9 * std::abs(fit.log_likelihood))
        << run;
    if (fit.undetermined) {
      continue;
    }
    ++determined;
    const auto within = [](double x) { return 0.03 - 0.03 * std::cos(x); };  // 0 .. 0.06
    const auto minus = [&](std::span<const double> x) {
      FittedParameters p{x[0], spacing + std::exp(x[1]), within(x[2]), 0.5};
      p.guess = o.task == Task::kForcedChoice     ? 0.5
                : o.task == Task::kEqualAsymptote ? p.lapse
                                                  : within(x[3]);
      return -log_likelihood(fitted_function(o.function, p), blocks);
    };
    const auto truth = observer().parameters();
    const std::vector<double> start{axis.at(truth.threshold), std::log(truth.width - spacing), 1.5,
                                    1.5};
    const Minimum other = find_minimum(minus, start, std::vector{0.2, 0.2, 0.5, 0.5});
    EXPECT_GE(fit.log_likelihood, -other.value - 1e-7) << run;
  }
  EXPECT_GT(determined, 50);
}

INSTANTIATE_TEST_SUITE_P(
    All, LikelihoodFitKinds,
    testing::Values(Kind{"norm", Task::kForcedChoice}, Kind{"norm", Task::kYesNo},
                    Kind{"norm", Task::kEqualAsymptote}, Kind{"logistic", Task::kForcedChoice},
                    Kind{"logistic", Task::kYesNo}, Kind{"gumbel", Task::kForcedChoice},
                    Kind{"rgumbel", Task::kYesNo}, Kind{"Weibull", Task::kForcedChoice},
                    Kind{"logn", Task::kYesNo}, Kind{"tdist", Task::kYesNo},
                    Kind{"neg_norm", Task::kYesNo}, Kind{"neg_gumbel", Task::kForcedChoice}));

// Two levels and no lapses: the function passes through both shares.
TEST(LikelihoodFit, PassesThroughTwoShares) {
  LikelihoodOptions options{.function = parameters_named("logistic"), .task = Task::kYesNo};
  options.lapse = options.guess = {0.0, 0.0};
  const std::vector<TrialBlock> blocks{{1.0, 2, 10}, {3.0, 9, 10}};
  const LikelihoodFit fit = likelihood_fit(blocks, options);
  // logit(p) = a + b x
  const double low = std::log(0.2 / 0.8), high = std::log(0.9 / 0.1), b = (high - low) / 2.0;
  EXPECT_TRUE(fit.converged);
  EXPECT_NEAR(fit.parameters.threshold, 1.0 - low / b, 1e-9);
  EXPECT_NEAR(fit.parameters.width, 2.0 * std::log(0.95 / 0.05) / b, 1e-9);
}

TEST(LikelihoodFit, SaysWhereTheAnswersDoNotTell) {
  LikelihoodOptions options{.function = parameters_named("norm"), .task = Task::kYesNo};
  const std::vector<TrialBlock> stepped{{1, 0, 20}, {2, 0, 20}, {3, 20, 20}, {4, 20, 20}};
  const LikelihoodFit fit = likelihood_fit(stepped, options);
  EXPECT_TRUE(fit.undetermined);
  EXPECT_GT(fit.parameters.threshold, 2.0);
  EXPECT_LT(fit.parameters.threshold, 3.0);
  const std::vector<TrialBlock> all{{1, 20, 20}, {2, 20, 20}, {3, 20, 20}};
  EXPECT_TRUE(likelihood_fit(all, options).undetermined);
}

// A likelihood does not know on which scale its function is stated: natural logarithms, decimal
// ones and decibels give one function, and the widths have the ratios of the scales.
TEST(LikelihoodFit, TheScaleOfTheAxisDoesNotMatter) {
  RandomStream random(6, "likelihood fit");
  LikelihoodOptions options{.function = parameters_named("neg_Weibull", 0.5)};
  options.function.axis = {psychometric::Scale::kNaturalLog, -1.0, "N/m"};
  options.function.share = 0.4;
  const auto observer = fitted_function(options.function, {0.8, 1.0, 0.02, 0.5});
  const auto blocks = answers(random, observer, 60);
  const FittedParameters natural = likelihood_fit(blocks, options).parameters;
  const PsychometricFunction one = fitted_function(options.function, natural);
  for (const auto& [scale, ratio] : {std::pair{psychometric::Scale::kLog10, std::log10(M_E)},
                                     {psychometric::Scale::kDecibel, 20.0 * std::log10(M_E)}}) {
    options.function.axis.scale = scale;
    const FittedParameters other = likelihood_fit(blocks, options).parameters;
    const PsychometricFunction two = fitted_function(options.function, other);
    EXPECT_NEAR(other.width / natural.width, ratio, 1e-6);
    EXPECT_NEAR(two.parameters().threshold, one.parameters().threshold, 1e-6);
    for (const TrialBlock& block : blocks) {
      EXPECT_NEAR(two(block.level), one(block.level), 1e-6);
      EXPECT_NEAR(two.derivative(block.level), one.derivative(block.level), 1e-6);
    }
    EXPECT_EQ(two.parameters().axis.unit, "N/m");
  }
  EXPECT_TRUE(one.parameters().falling);
  EXPECT_NEAR(one(one.level_for_share(0.4)), 0.5 + (0.5 - natural.lapse) * 0.4, 1e-12);
  EXPECT_NEAR(one.level_for_share(0.4), one.parameters().threshold, 1e-12);
}

TEST(LikelihoodFit, DoesNotAllocate) {
  RandomStream random(3, "likelihood fit");
  const auto observer = fitted_function(parameters_named("norm"), {2.2, 2.0, 0.02, 0.5});
  const auto blocks = answers(random, observer, 40);
  const LikelihoodFitter fitter({}, blocks);
  std::vector<int> correct;
  for (const TrialBlock& b : blocks) {
    correct.push_back(b.correct);
  }
  const test::AllocationGuard guard;
  const LikelihoodFit fit = fitter.fit(correct);
  EXPECT_EQ(guard.count(), 0u);
  EXPECT_TRUE(fit.converged);
}

TEST(LikelihoodFit, RefusesWhatIsOutOfBounds) {
  const std::vector<TrialBlock> blocks{{1, 2, 10}, {2, 8, 10}};
  LikelihoodOptions options;
  options.function.guess = 0.0;
  EXPECT_THROW(likelihood_fit(blocks, options), std::invalid_argument);
  options.function.guess = 0.5;
  options.lapse = {0.1, 0.05};
  EXPECT_THROW(likelihood_fit(blocks, options), std::invalid_argument);
  options.lapse = {};
  EXPECT_THROW(likelihood_fit(std::vector<TrialBlock>{{1, 2, 10}}, options), std::invalid_argument);
  EXPECT_THROW(likelihood_fit(std::vector<TrialBlock>{{1, 12, 10}, {2, 3, 4}}, options),
               std::invalid_argument);
  options.function = parameters_named("Weibull", 0.5);
  EXPECT_THROW(likelihood_fit(std::vector<TrialBlock>{{0.0, 2, 10}, {2, 3, 4}}, options),
               std::invalid_argument);
}

std::vector<BootstrapTarget> all_asked() {
  return {{Reading::kThreshold},
          {Reading::kSlope, 0.5},
          {Reading::kLevelOfProbability, 0.75},
          {Reading::kWeberQuartiles, 0.5, 2.0}};
}

TEST(BootstrapFit, DoesNotDependOnTheThreads) {
  RandomStream random(5, "bootstrap fit");
  const LikelihoodOptions options{.function = parameters_named("norm"), .task = Task::kYesNo};
  const auto blocks =
      answers(random, fitted_function(options.function, {2.2, 2.0, 0.02, 0.02}), 40);
  for (const bool parametric : {true, false}) {
    FitBootstrap how{.parametric = parametric};
    how.resampling.count = 999;
    const BootstrappedFit one = bootstrap_fit(blocks, options, all_asked(), how);
    how.resampling.threads = 3;
    const BootstrappedFit three = bootstrap_fit(blocks, options, all_asked(), how);
    how.resampling.seed = 2;
    const BootstrappedFit other = bootstrap_fit(blocks, options, all_asked(), how);
    EXPECT_EQ(one.deviance_p, three.deviance_p);
    for (std::size_t a = 0; a < all_asked().size(); ++a) {
      ASSERT_TRUE(one.intervals[a]) << one.intervals[a].because();
      EXPECT_EQ(one.intervals[a]->low, three.intervals[a]->low);
      EXPECT_EQ(one.intervals[a]->high, three.intervals[a]->high);
      EXPECT_NE(one.intervals[a]->low, other.intervals[a]->low);
      EXPECT_LT(one.intervals[a]->low, one.estimates[a]);
      EXPECT_GT(one.intervals[a]->high, one.estimates[a]);
    }
  }
}

// Without lapses and guesses a probit fit has Fisher's information in closed form: with many
// trials the interval of the threshold is 1.96 standard errors to either side.
TEST(BootstrapFit, HasTheWidthThatFishersInformationGives) {
  LikelihoodOptions options{.function = parameters_named("norm"), .task = Task::kYesNo};
  options.lapse = options.guess = {0.0, 0.0};
  const PsychometricFunction truth = fitted_function(options.function, {2.2, 2.0});
  std::vector<TrialBlock> blocks;
  double a = 0.0, b = 0.0, c = 0.0;  // information of intercept and slope of z = rise (x - 2.2)
  const double rise = psychometric::rate_of_width(options.function.sigmoid, 2.0);
  for (int i = 0; i < 8; ++i) {
    const double x = 0.5 + 0.5 * i, p = truth(x), z = rise * (x - 2.2);
    blocks.push_back({x, static_cast<int>(std::lround(4000 * p)), 4000});
    const double density = std::exp(-0.5 * z * z) / std::sqrt(2.0 * M_PI);
    const double weight = 4000 * density * density / (p * (1.0 - p));
    a += weight, b += weight * (x - 2.2), c += weight * (x - 2.2) * (x - 2.2);
  }
  const double error = std::sqrt(c / (a * c - b * b)) / rise;
  FitBootstrap how;
  how.resampling.count = 4999;
  const auto fit = bootstrap_fit(blocks, options, all_asked(), how);
  // 4,999 draws give a quantile to about 2 % of the interval's width.
  EXPECT_NEAR(fit.intervals[0]->high - fit.intervals[0]->low, 2.0 * 1.959964 * error,
              0.06 * 2.0 * 1.959964 * error);
  EXPECT_GT(fit.deviance_p, 0.5);  // the shares are those of the function
}

TEST(BootstrapFit, FindsThatAFunctionDoesNotDescribeTheAnswers) {
  const std::vector<TrialBlock> uneven{
      {1, 2, 40}, {2, 30, 40}, {3, 5, 40}, {4, 36, 40}, {5, 30, 40}};
  const LikelihoodOptions options{.function = parameters_named("norm"), .task = Task::kYesNo};
  FitBootstrap how;
  how.resampling.count = 999;
  EXPECT_LE(bootstrap_fit(uneven, options, {}, how).deviance_p, 0.001);
}

}  // namespace
}  // namespace haptrial::analysis::likelihood_fit_test
