#pragma once

#include <vector>

#include "analysis/psychophysics/study/detected.h"
#include "analysis/psychophysics/study/quantity.h"
#include "analysis/psychophysics/study/timed.h"

namespace haptrial::analysis::trials {

/// Drift rate, boundary separation [s^1/2] and non-decision time [s] of the conditions whose model
/// is defined. A planned direction is that of times; these are tested on both sides.
std::vector<Quantity> diffusion_quantities(const std::vector<TimedCondition>& all,
                                           const TrialsPlan& plan);

/// meta-d' and M-ratio of the conditions that have them.
std::vector<Quantity> metacognition_quantities(const std::vector<DetectedCondition>& all,
                                               const TrialsPlan& plan);
std::vector<Quantity> metacognition_quantities(const std::vector<IdentifiedCondition>& all,
                                               const TrialsPlan& plan);

}  // namespace haptrial::analysis::trials
