#include "analysis/psychometric/fit/bootstrap_fit.h"

#include <gsl/gsl_randist.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/base/random.h"

namespace haptrial::analysis {
namespace {

using psychometric::PsychometricFunction;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

std::vector<int> answers_of(std::span<const TrialBlock> blocks) {
  std::vector<int> correct;
  for (const TrialBlock& block : blocks) {
    correct.push_back(block.correct);
  }
  return correct;
}

std::vector<double> shares_of(std::span<const TrialBlock> blocks) {
  std::vector<double> shares;
  for (const TrialBlock& block : blocks) {
    shares.push_back(static_cast<double>(block.correct) / block.total);
  }
  return shares;
}

void check_asked(std::span<const BootstrapTarget> asked) {
  for (const BootstrapTarget& a : asked) {
    if (!(a.at > 0.0 && a.at < 1.0)) {
      throw std::invalid_argument("at of a reading must lie inside (0, 1)");
    }
    if (!(a.standard > 0.0)) {
      throw std::invalid_argument("standard of a Weber fraction must be above 0");
    }
  }
}

/// Readings without each trial of each block, for each reading that is asked for.
std::vector<std::vector<std::vector<double>>> without_trials(
    const LikelihoodFitter& fitter, std::span<const TrialBlock> blocks,
    std::span<const BootstrapTarget> asked) {
  const std::vector<int> correct = answers_of(blocks);
  std::vector<std::vector<std::vector<double>>> result(
      asked.size(), std::vector<std::vector<double>>(blocks.size()));
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    for (const bool right : {true, false}) {
      const int count = right ? correct[i] : blocks[i].total - correct[i];
      if (count == 0) {
        continue;
      }
      const PsychometricFunction function =
          fitter.function(fitter.fit_without(correct, i, right).parameters);
      for (std::size_t a = 0; a < asked.size(); ++a) {
        result[a][i].insert(result[a][i].end(), static_cast<std::size_t>(count),
                            read_off(function, asked[a]));
      }
    }
  }
  return result;
}

/// Fits of the resamples.
struct Drawn {
  std::vector<std::vector<double>> readings;  // (asked x resamples)
  std::vector<char> undetermined;             // (resamples)
  std::vector<double> deviances;              // (resamples)
};

Drawn drawn_fits(const LikelihoodFitter& fitter, std::span<const TrialBlock> blocks,
                 std::span<const BootstrapTarget> asked, const AnswerDraws& draws,
                 const Resampling& resampling) {
  Drawn drawn{std::vector(asked.size(), std::vector<double>(resampling.count)),
              std::vector<char>(resampling.count), std::vector<double>(resampling.count)};
  for_each_part(resampling, [&](RandomStream& random, std::size_t first, std::size_t last) {
    std::vector<int> correct(blocks.size());
    std::vector<TrialBlock> answered(blocks.begin(), blocks.end());
    for (std::size_t r = first; r < last; ++r) {
      draws.draw(random, correct);
      const LikelihoodFit fit = fitter.fit(correct);
      const PsychometricFunction function = fitter.function(fit.parameters);
      for (std::size_t a = 0; a < asked.size(); ++a) {
        drawn.readings[a][r] = read_off(function, asked[a]);
      }
      for (std::size_t i = 0; i < blocks.size(); ++i) {
        answered[i].correct = correct[i];
      }
      drawn.undetermined[r] = fit.undetermined ? 1 : 0;
      drawn.deviances[r] = deviance_of(function, answered).deviance;
    }
  });
  return drawn;
}

}  // namespace

double read_off(const PsychometricFunction& function, const BootstrapTarget& asked) {
  const psychometric::PsychometricParameters& p = function.parameters();
  switch (asked.reading) {
    case Reading::kThreshold:
      return p.threshold;
    case Reading::kWidth:
      return p.width;
    case Reading::kLapse:
      return p.lapse;
    case Reading::kGuess:
      return p.guess;
    case Reading::kLevelOfShare:
      return function.level_for_share(asked.at);
    case Reading::kLevelOfProbability:
      return asked.at > p.guess && asked.at < 1.0 - p.lapse ? function.level_for(asked.at) : kNone;
    case Reading::kSlope:
      return function.derivative(function.level_for_share(asked.at));
    case Reading::kWeberThreshold:
      return std::abs(function.level_for_share(asked.at) - asked.standard) / asked.standard;
    case Reading::kWeberQuartiles:
      break;
  }
  return 0.5 * std::abs(function.level_for_share(0.75) - function.level_for_share(0.25)) /
         asked.standard;
}

FitBootstrap bootstrap_of(const std::string& participant, const std::string& condition) {
  FitBootstrap how;
  how.resampling.stream = "psychometric bootstrap " + participant + " " + condition;
  return how;
}

BootstrappedFit bootstrap_fit(std::span<const TrialBlock> blocks, const LikelihoodOptions& options,
                              std::span<const BootstrapTarget> asked, const FitBootstrap& how) {
  check_asked(asked);
  const LikelihoodFitter fitter(options, blocks);
  BootstrappedFit result;
  result.fit = fitter.fit(answers_of(blocks));
  const PsychometricFunction function = fitter.function(result.fit.parameters);
  result.deviance = deviance_of(function, blocks);
  const AnswerDraws draws =
      how.parametric ? AnswerDraws(blocks, function) : AnswerDraws(blocks, shares_of(blocks));
  Drawn drawn = drawn_fits(fitter, blocks, asked, draws, how.resampling);
  result.undetermined =
      static_cast<std::size_t>(std::count(drawn.undetermined.begin(), drawn.undetermined.end(), 1));
  const auto jackknife = without_trials(fitter, blocks, asked);
  for (std::size_t a = 0; a < asked.size(); ++a) {
    result.estimates.push_back(read_off(function, asked[a]));
    const auto corrected =
        bca_interval(result.estimates[a], drawn.readings[a], jackknife[a], how.level);
    result.intervals.push_back(
        corrected ? corrected
                  : percentile_interval(result.estimates[a], drawn.readings[a], how.level));
  }
  if (!how.parametric) {
    Resampling again = how.resampling;
    again.stream += "/deviance";
    drawn = drawn_fits(fitter, blocks, {}, AnswerDraws(blocks, function), again);
  }
  const auto larger = std::count_if(drawn.deviances.begin(), drawn.deviances.end(), [&](double d) {
    return d >= result.deviance.deviance * (1.0 - 1e-9);
  });
  result.deviance_p =
      (static_cast<double>(larger) + 1.0) / (static_cast<double>(how.resampling.count) + 1.0);
  return result;
}

namespace {

std::vector<double> expected_shares(std::span<const TrialBlock> blocks,
                                    const psychometric::PsychometricFunction& function) {
  std::vector<double> shares;
  for (const TrialBlock& block : blocks) {
    shares.push_back(std::clamp(probability_of(function, block), 0.0, 1.0));
  }
  return shares;
}

}  // namespace

AnswerDraws::AnswerDraws(std::span<const TrialBlock> blocks, std::span<const double> shares) {
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    std::vector<double>& below = below_.emplace_back();
    double sum = 0.0;
    for (int k = 0; k < blocks[i].total; ++k) {
      sum += gsl_ran_binomial_pdf(static_cast<unsigned>(k), shares[i],
                                  static_cast<unsigned>(blocks[i].total));
      below.push_back(sum);
    }
  }
}

AnswerDraws::AnswerDraws(std::span<const TrialBlock> blocks,
                         const psychometric::PsychometricFunction& function)
    : AnswerDraws(blocks, expected_shares(blocks, function)) {}

void AnswerDraws::draw(RandomStream& random, std::span<int> correct) const noexcept {
  for (std::size_t i = 0; i < below_.size(); ++i) {
    const auto place = std::upper_bound(below_[i].begin(), below_[i].end(), random.uniform());
    correct[i] = static_cast<int>(place - below_[i].begin());
  }
}

}  // namespace haptrial::analysis
