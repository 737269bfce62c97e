#pragma once

#include <vector>

#include "analysis/psychophysics/data/trials_data.h"
#include "analysis/psychophysics/study/quantity.h"

namespace haptrial::analysis::trials {

/// Choices that each pair of items is given besides the answers, of either.
inline constexpr double kAddedChoices = 0.5;

/// Choices in pairs, tested between items: the worths of PairedPlan::model, and the share of the
/// trials with an item in which it was chosen. A value is one participant's for an item under a
/// condition. Only items that the participant met there have one.
std::vector<Quantity> paired_quantities(const TrialsData& data, const TrialsPlan& plan);

}  // namespace haptrial::analysis::trials
