#pragma once

#include <vector>

#include "analysis/psychophysics/study/quantity.h"

namespace haptrial::analysis::trials {

struct TrialsData;

/// The measure of ProducedPlan, and with ProducedPlan::target its constant, absolute and variable
/// error, tested between the conditions of TrialsPlan::by. A value is a participant's under a
/// condition: the mean over trials; the variable error is the standard deviation of the errors of
/// at least two trials.
/// @throws InputError as quantity() does
std::vector<Quantity> produced_quantities(const TrialsData& data, const TrialsPlan& plan);

}  // namespace haptrial::analysis::trials
