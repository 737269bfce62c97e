#pragma once

#include <span>
#include <string>
#include <vector>

#include "analysis/psychometric/fit/likelihood_fit.h"
#include "analysis/psychometric/fit/trial_blocks.h"
#include "analysis/statistics/base/defined.h"
#include "analysis/statistics/base/resampling.h"
#include "analysis/statistics/tests/bootstrap.h"

namespace haptrial {
class RandomStream;
}

namespace haptrial::analysis {

/// A number that is read off a psychometric function.
enum class Reading {
  kThreshold,  // the level of S = share
  kWidth,      // on the axis
  kLapse,
  kGuess,
  kLevelOfShare,        // the level of S = at, free of guesses and lapses
  kLevelOfProbability,  // the level of P(correct) = at
  kSlope,               // d P / d level at the level of S = at
  kWeberThreshold,      // |level of S = at - standard| / standard: forced choice against a standard
  kWeberQuartiles,      // (level of S = 3/4 - that of 1/4) / 2 / standard: "larger" or "smaller"
};

struct BootstrapTarget {
  Reading reading{Reading::kThreshold};
  double at{0.5};        // where the reading takes a share or a probability, inside (0, 1)
  double standard{1.0};  // of a Weber fraction, > 0 [unit of the level]
};

/// The number; NaN where the function does not have it.
double read_off(const psychometric::PsychometricFunction& function, const BootstrapTarget& asked);

struct FitBootstrap {
  Resampling resampling{.stream = "psychometric bootstrap"};
  /// Answers drawn from the fitted function; otherwise from the shares of each block themselves.
  bool parametric{true};
  double level{0.95};
};

struct BootstrappedFit {
  LikelihoodFit fit;
  PsychometricDeviance deviance;
  std::vector<double> estimates;                      // one for each asked
  std::vector<Defined<BootstrapInterval>> intervals;  // corrected, else percentiles
  /// The share of simulated observers who have the fitted function and a deviance at least as
  /// large: (b + 1) / (m + 1). Small where the function does not describe the answers.
  double deviance_p{1.0};
  /// Resamples whose threshold or width is undetermined.
  std::size_t undetermined{0};
};

/// The bootstrap of a participant's function under a condition: its draws are those of every fit
/// with these names, in a report or anywhere else. Empty names: there are none.
FitBootstrap bootstrap_of(const std::string& participant, const std::string& condition);

/// The fit with bootstrap intervals of anything that can be read off it. For threshold and width
/// take profiled_fit(), whose intervals hold the truth more reliably. Each resample draws all
/// answers anew and fits them. The result depends on seed and name of the stream alone, not on the
/// number of threads.
/// @throws std::invalid_argument as LikelihoodFitter, and naming what of `asked` breaks its bound.
/// Source: Wichmann and Hill 2001, Perception & Psychophysics 63, 1293 and 1314.
BootstrappedFit bootstrap_fit(std::span<const TrialBlock> blocks, const LikelihoodOptions& options,
                              std::span<const BootstrapTarget> asked, const FitBootstrap& how);

/// Draws answers to the levels of blocks: binomial, one uniform number a block.
class AnswerDraws {
 public:
  /// @param shares  of answers 1, one a block, in [0, 1]
  AnswerDraws(std::span<const TrialBlock> blocks, std::span<const double> shares);
  /// Shares from a function.
  AnswerDraws(std::span<const TrialBlock> blocks,
              const psychometric::PsychometricFunction& function);

  /// @param correct  (blocks) gets the numbers of answers 1; no allocation
  void draw(RandomStream& random, std::span<int> correct) const noexcept;

 private:
  std::vector<std::vector<double>> below_;  // (blocks) P(answers 1 <= k), k from 0 to total - 1
};

}  // namespace haptrial::analysis
