#pragma once

#include <string>

#include "analysis/psychophysics/study/trials_result.h"

namespace haptrial::analysis::trials {

/// A tidy table with a row for each estimate: participant, the plan's factors, source (likelihood,
/// posterior of adaptive trials, bayesian, procedure, detection, magnitude), name, estimate, low,
/// high (95 %), unit. What is not known is empty; what is not defined has no row.
std::string estimates_csv(const TrialsResult& result);

}  // namespace haptrial::analysis::trials
