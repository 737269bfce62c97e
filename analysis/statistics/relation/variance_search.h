#pragma once

#include <optional>

#include "analysis/statistics/relation/restricted_likelihood.h"

namespace haptrial::analysis {

/// The lowest point of the criterion over rho >= 0, to the last digits: a scan of each rho in turn,
/// then Newton's method with the rhos held at 0 that would fall below.
/// Nothing if the criterion falls without end.
std::optional<RestrictedLikelihood::Slopes> lowest_point(const RestrictedLikelihood& likelihood);

}  // namespace haptrial::analysis
