#pragma once

#include <vector>

#include "analysis/psychophysics/fit/reaching_study.h"
#include "analysis/psychophysics/study/quantity.h"

namespace haptrial::analysis::trials {

/// The quantities of reaches that a plan compares, tested between the conditions of TrialsPlan::by,
/// planned tests among them. A value is a participant's mean under a condition over the reaches
/// without a probe (of force compensation: those in a channel) of the plan's cycles. Nothing if
/// `by` is empty.
/// @param data  that the reaches are of
/// @throws InputError as quantity() does
std::vector<Quantity> reach_quantities(const TrialsData& data, const ReachingResult& reaching,
                                       const TrialsPlan& plan);

}  // namespace haptrial::analysis::trials
