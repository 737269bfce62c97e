#pragma once

#include <string>
#include <vector>

#include "analysis/psychometric/fit/bayesian_fit.h"
#include "analysis/psychometric/fit/bootstrap_fit.h"
#include "analysis/trials/fit/series.h"

namespace haptrial::analysis::trials {

/// A number with its interval, if it has one.
struct Estimated {
  double value{kNotKnown};
  double low{kNotKnown}, high{kNotKnown};  // 95 %; NaN: not defined; infinite: no end

  bool known() const { return value == value; }
};

/// The readings of a function, by either way of fitting.
struct FunctionReadings {
  Estimated threshold;  // level at which S is the plan's share [unit of the level]
  Estimated x;          // the same on the axis
  Estimated width;      // [unit of the axis]
  Estimated slope;      // d P / d level at the threshold; likelihood alone
  Estimated weber;      // NaN without a reference
  Estimated lapse;
  Estimated guess;  // NaN: it is known
};

/// Where the function reaches a share, with the interval of that level.
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
  Defined<FunctionReadings> likelihood{Undefined{"nothing was fitted"}};
  Defined<FunctionReadings> bayesian{Undefined{"nothing was fitted"}};
  FittedParameters fitted;  // of the likelihood
  double deviance{kNotKnown};
  double deviance_p{kNotKnown};       // of the parametric bootstrap; NaN: none was drawn
  double overdispersion{kNotKnown};   // eta of the Bayesian fit; 0: binomial
  std::vector<BandPoint> band;        // rising shares; empty: there was no bootstrap
  std::vector<std::string> warnings;  // sentences

  /// The likelihood's function. @throws std::logic_error where it is not defined.
  psychometric::PsychometricFunction function(const TrialsPlan& plan) const;
};

/// How the plan's functions are fitted.
LikelihoodOptions likelihood_options(const TrialsPlan& plan);

/// Fits the function of a series: maximum likelihood with profile intervals of threshold, width and
/// what follows from one of them, and bootstrap intervals of the rest (bias-corrected and
/// accelerated, from the fitted function); of adaptive trials with intervals of the posterior,
/// which does not depend on how levels were chosen (adaptive_posterior.h); and the Bayesian
/// beta-binomial fit with the percentiles of its posterior. Not defined with answers at fewer than
/// two levels, or where they do not tell the threshold.
/// @param threads  of the bootstrap and the grid
FunctionFit fit_series(const AnsweredSeries& series, const TrialsPlan& plan, int threads);

}  // namespace haptrial::analysis::trials
