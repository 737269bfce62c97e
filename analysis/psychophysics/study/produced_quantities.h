#pragma once

#include <vector>

#include "analysis/psychophysics/study/detected.h"
#include "analysis/psychophysics/study/quantity.h"
#include "analysis/psychophysics/study/timed.h"

namespace haptrial::analysis::trials {

struct TrialsData;

/// The measure of ProducedPlan, and with ProducedPlan::target its constant, absolute and variable
/// error, tested between the conditions of TrialsPlan::by. A value is a participant's under a
/// condition: the mean over trials; the variable error is the standard deviation of the errors of
/// at least two trials.
/// @throws InputError as quantity() does
std::vector<Quantity> produced_quantities(const TrialsData& data, const TrialsPlan& plan);

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
