#pragma once

#include <vector>

#include "core/psychometric/procedure/procedure.h"

namespace haptrial::psychometric {

/// The mean of what was found from below and from above, where the side from which one comes makes
/// a difference: with two or more of either kind the mean of the sides' means, whose deviation has
/// only the scatter within sides; else the mean of all. Its name stays empty.
/// @param below, above  together at least one
Estimate mean_of_sides(const std::vector<double>& below, const std::vector<double>& above);

/// Whether both sides count alike in that mean.
bool sides_count_alike(const std::vector<double>& below, const std::vector<double>& above);

}  // namespace haptrial::psychometric
