#pragma once

#include <span>

#include "analysis/alignment/curves.h"
#include "analysis/alignment/options.h"

namespace haptrial::analysis {

/// The cost of a given path in double precision and the weights in it, as Alignment has them.
/// Preconditions: options without a problem; the path lies inside the curves.
double path_cost(const CurveView& target, const CurveView& applied, const AlignmentOptions& options,
                 std::span<const PathPoint> path);
double path_weight(StepPattern pattern, std::span<const PathPoint> path);

}  // namespace haptrial::analysis
