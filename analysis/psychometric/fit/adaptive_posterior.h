#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "analysis/psychometric/fit/credible.h"
#include "analysis/psychometric/fit/fitted_function.h"
#include "analysis/psychometric/fit/likelihood_fit.h"
#include "analysis/psychometric/fit/trial_blocks.h"

namespace haptrial::analysis {

/// Number of draws that reports take.
inline constexpr std::size_t kPosteriorDraws = 999;

/// Posterior of a function after answers to adaptively chosen levels.
struct AdaptivePosterior {
  FittedParameters median;              // of each parameter
  CredibleInterval threshold;           // [axis]
  CredibleInterval width;               // [axis]
  CredibleInterval lapse, guess;        // a point if the rate is known
  std::vector<FittedParameters> draws;  // each as probable as the others
  /// The density at the lowest and at the highest threshold of the prior over the largest one: if
  /// the answers do not exclude a threshold there, the prior cuts the interval off.
  double low_end{0.0}, high_end{0.0};
  /// Whether the lapse rate's interval is clearly shorter than that of its prior.
  bool lapse_told{true};
};

/// The posterior of threshold, width, lapse and, in yes/no tasks, guess rate from binomial answers.
/// A likelihood does not depend on how a procedure chose its levels, so the intervals of a
/// posterior stay what they are with adaptive trials, in which the cut of a profile likelihood does
/// not hold (docs/algorithms/procedure-coverage.md). With s = highest - lowest level that could be
/// presented and d = the smallest distance of those that were, the prior is
///
///     threshold   uniform from s / 2 below the lowest level to s / 2 above the highest
///     width       1 / (w + s / 10); 0 at d, cosine up to all of it at 2 d, cosine down from s to
///                 0 at 3 s (ends as psignifit's)
///     lapse rate  Beta(1, 10) between its bounds, as psignifit's
///     guess rate  uniform between its bounds
///
/// A prior uniform in the width makes intervals of single tracks too long, one uniform in its
/// logarithm those of fine steps too short; this is the one below s / 10 and the other above.
/// On a grid that follows the posterior; some 5 ms.
/// @param level  of the central intervals, inside (0, 1)
/// @param draws  how many
/// @throws std::invalid_argument as LikelihoodFitter, or naming level
/// Source: Gregory 2005, Bayesian Logical Data Analysis, 3.10 (the prior of a scale).
AdaptivePosterior adaptive_posterior(std::span<const TrialBlock> blocks,
                                     const LikelihoodOptions& options, double level = 0.95,
                                     std::size_t draws = 0);

}  // namespace haptrial::analysis
