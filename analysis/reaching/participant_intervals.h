#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "analysis/statistics/base/defined.h"
#include "analysis/statistics/base/resampling.h"
#include "analysis/statistics/tests/bootstrap.h"

namespace haptrial::analysis {

/// Several numbers from the participants of the given rows; a row may come more than once. Nothing
/// where they do not exist. Called by several threads at once.
using ParticipantEstimator =
    std::function<std::optional<std::vector<double>>(std::span<const std::size_t> rows)>;

struct ParticipantResampling {
  Resampling resampling{.stream = "participants"};
  double level{0.95};  // coverage of the intervals, inside (0, 1)
};

/// Bias-corrected and accelerated intervals by drawing participants with replacement, all numbers
/// from the same draws. So few participants make such an interval too narrow; it is widened to the
/// level 1 - 2 Φ(-t sqrt(n / (n - 1))), with Student's t of n - 1 degrees of freedom.
/// Source: Hesterberg 2015, The American Statistician 69, 371 (expanded percentile intervals).
/// @param estimates  of all participants; one result for each.
/// A skewed number from few participants needs 2,000 draws or more. Draws without numbers are left
/// out, and BootstrapInterval::resamples counts the others.
/// Undefined, each on its own, as bca_interval, with fewer than three participants, if more than a
/// tenth of the draws have no numbers, or if there are none without one of the participants.
/// @throws std::invalid_argument when the level breaks its bound.
std::vector<Defined<BootstrapInterval>> participant_intervals(std::size_t participants,
                                                              const std::vector<double>& estimates,
                                                              const ParticipantEstimator& estimator,
                                                              const ParticipantResampling& how);

}  // namespace haptrial::analysis
