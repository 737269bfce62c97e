#pragma once

#include <vector>

#include "analysis/psychophysics/data/trials_data.h"
#include "analysis/psychophysics/study/quantity.h"

namespace haptrial::analysis::trials {

/// Choices in pairs, tested between items: the worths of PairedPlan::model, and the share of the
/// trials with an item in which it was chosen. A value is one participant's for an item under a
/// condition. Values compare only between the same items, all of those that anybody met there:
/// worths need a chain of presented pairs that links them, shares the same opponents, every pair.
/// A mean worth has no interval if it is open for most participants (open_worths).
std::vector<Quantity> paired_quantities(const TrialsData& data, const TrialsPlan& plan);

}  // namespace haptrial::analysis::trials
