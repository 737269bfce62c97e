#pragma once

#include <span>

#include "analysis/psychometric/fit/likelihood_fit.h"

namespace haptrial::analysis {

/// The values that a likelihood-ratio test does not reject. An open side has no end within the
/// bounds of LikelihoodFitter: the answers do not tell how far it goes, and its number is the bound
/// of a threshold, 0 or infinity of a width.
struct ProfileInterval {
  double low{0.0};
  double high{0.0};
  bool low_open{false};
  bool high_open{false};

  bool holds(double value) const noexcept {
    return (low_open || value >= low) && (high_open || value <= high);
  }
};

/// The fit, the likeliest of several maxima that a search finds, with intervals of its threshold
/// [axis] and its width [axis].
struct ProfiledFit {
  LikelihoodFit fit;
  ProfileInterval threshold;
  ProfileInterval width;
};

/// The fit with intervals by profile likelihood. A value v of threshold or width lies inside if
///
///     2 (max l - max l with v held) <= c
///
/// with c the `level` quantile of the chi-square distribution with one degree of freedom. Lapse and
/// guess rate (and width, or threshold) are fitted anew for each v, within their bounds. Intervals
/// follow a change of scale: those of a level, a Weber fraction against a standard or a slope free
/// of lapses are the same interval converted, and another share has its own fit.
///
/// This is the interval that reports state of trials at listed levels: it holds the truth as often
/// as it says, which bootstrap_fit's does not. After adaptive trials it holds too rarely, and
/// adaptive_posterior() is for them (docs/algorithms/procedure-coverage.md).
/// No allocation. @param level  inside (0, 1); @throws std::invalid_argument naming it.
/// Source: Venzon and Moolgavkar 1988, Applied Statistics 37, 87.
ProfiledFit profiled_fit(const LikelihoodFitter& fitter, std::span<const int> correct,
                         double level = 0.95);

/// The same for blocks. @throws std::invalid_argument as LikelihoodFitter.
ProfiledFit profiled_fit(std::span<const TrialBlock> blocks, const LikelihoodOptions& options,
                         double level = 0.95);

}  // namespace haptrial::analysis
