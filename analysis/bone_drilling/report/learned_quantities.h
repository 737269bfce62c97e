#pragma once

#include <span>
#include <string>
#include <vector>

#include "analysis/bone_drilling/metrics/metrics.h"
#include "analysis/learning/learned_study.h"

namespace haptrial::analysis::drilling {

/// The outcomes that a learning plan may name: columns of metrics.csv without their units.
LearningOutcomes drilling_outcomes();

/// The values of outcomes in all procedures. @throws InputError for one that no procedure has
std::vector<LearningQuantity> learned_quantities(std::span<const ProcedureSummary> procedures,
                                                 const std::vector<std::string>& outcomes);

}  // namespace haptrial::analysis::drilling
