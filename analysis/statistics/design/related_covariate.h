#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "analysis/statistics/design/analysis_plan.h"
#include "analysis/statistics/design/design_table.h"

namespace haptrial::analysis {

/// A made covariate for simulated participants, with a stated relation to what a test compares:
///
///     value = r z + sqrt(1 - r²) e,   e normal
///
/// z is what the test compares, with mean 0 and variance 1: of the same people their difference, of
/// different people the value less the mean of their side. With normal values the power of the
/// adjusted test is that of a residual variance 1 - r² times as large.
/// @param correlation  r, inside (-1, 1)
/// @returns one value for each participant of the table; those who take no part in the test have e
std::map<std::string, double> related_covariate(const DesignTable& table, const PlannedTest& test,
                                                double correlation, std::uint64_t seed);

}  // namespace haptrial::analysis
