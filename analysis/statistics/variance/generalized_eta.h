#pragma once

#include <vector>

#include "analysis/statistics/tests/bootstrap.h"

namespace haptrial::analysis {

/// Generalized eta squared of a condition within participants, with a BCa interval from drawing
/// participants (whole rows) with replacement.
/// @param table  (participants x conditions), as for repeated_measures_anova.
/// Undefined as that and as bootstrap.
Defined<BootstrapInterval> generalized_eta_squared_interval(
    const std::vector<std::vector<double>>& table, const Resampling& resampling,
    double level = 0.95);

}  // namespace haptrial::analysis
