#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "analysis/statistics/design/design_table.h"

namespace haptrial::analysis {

/// How much participants changed from one level of a factor to its other levels, such as from a
/// pre-test to a post-test: the mean of each participant's values under each combination of levels,
/// less the mean under the same combination at the baseline. A comparison of these changes between
/// groups is the interaction of group and factor.
/// @param factor  place among the levels
/// @returns an observation for each participant and combination away from the baseline; none for
/// participants without values at the baseline
std::vector<Observation> changes_from(std::span<const Observation> observations, std::size_t factor,
                                      const std::string& baseline);

}  // namespace haptrial::analysis
