#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "analysis/psychometric/fit/bayesian_fit.h"
#include "analysis/psychometric/fit/bootstrap_fit.h"
#include "analysis/psychophysics/fit/estimated.h"
#include "analysis/psychophysics/fit/series.h"

namespace haptrial::analysis::trials {

/// The readings of a function, by either way of fitting. Each estimate lies within its interval.
struct FunctionReadings {
  Estimated threshold;  // level at which S is the plan's share [unit of the level]
  Estimated x;          // the same on the axis
  Estimated width;      // [unit of the axis]
  Estimated slope;      // d P / d level at the threshold; not of the Bayesian fit
  Estimated weber;      // NaN without a reference
  Estimated lapse;
  Estimated guess;  // NaN: it is known

  /// Whether the answers leave a side of the threshold's interval open.
  bool open() const { return std::isinf(x.low) || std::isinf(x.high); }
};

/// Level at which the function reaches a share, with its interval.
struct BandPoint {
  double share{0.5};  // S, lapses and guesses aside
  Estimated level;
};

/// The psychometric function of one participant under one condition.
struct FunctionFit {
  std::string participant;
  std::vector<std::string> levels;  // of the factors
  std::string condition;
  std::size_t trials{0};
  bool adaptive{false};  // levels depended on the answers
  std::vector<TrialBlock> blocks;
  /// Readings of the likelihood; of adaptive trials, of the posterior (stated_fit).
  Defined<FunctionReadings> stated{Undefined{"nothing was fitted"}};
  Defined<FunctionReadings> bayesian{Undefined{"nothing was fitted"}};
  FittedParameters fitted;                    // as stated
  std::optional<FittedParameters> likeliest;  // none: the answers do not tell threshold and width
  std::string no_interval;       // why the stated intervals would be wrong; empty: they are there
  bool lapse_told{true};         // else the lapse rate's interval is that of its prior
  double deviance{kNotKnown};    // of the likelihood
  double deviance_p{kNotKnown};  // of the parametric bootstrap, of listed levels else of chi-square
  double overdispersion{kNotKnown};   // eta of the Bayesian fit; 0: binomial
  std::vector<BandPoint> band;        // rising shares; empty: there was no bootstrap
  std::vector<std::string> warnings;  // sentences

  /// The stated function. @throws std::logic_error where it is not defined.
  psychometric::PsychometricFunction function(const TrialsPlan& plan) const;
};

/// How the plan's functions are fitted.
LikelihoodOptions likelihood_options(const TrialsPlan& plan);

/// A range of levels on the axis; none: an end is not there.
std::optional<SearchBounds> range_on_axis(const std::optional<psychometric::LevelRange>& range,
                                          const psychometric::Axis& axis);

/// Fits the function of a series. Listed levels: maximum likelihood with profile intervals of
/// threshold, width and what follows from one of them, and bootstrap intervals of the rest
/// (bias-corrected and accelerated, from the fitted function). Adaptive trials: medians and central
/// intervals of the posterior, which does not depend on how levels were chosen. Besides, the
/// Bayesian beta-binomial fit with the percentiles of its posterior. Not defined with answers at
/// fewer than two levels, or if they do not tell the threshold.
/// @param threads  of the bootstrap and the grid
FunctionFit fit_series(const AnsweredSeries& series, const TrialsPlan& plan, int threads);

}  // namespace haptrial::analysis::trials
