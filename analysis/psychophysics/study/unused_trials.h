#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "analysis/psychophysics/data/trials_data.h"
#include "analysis/psychophysics/fit/trials_plan.h"

namespace haptrial::analysis::trials {

/// Completed trials of which a kind of analysis makes nothing.
struct UnusedTrials {
  std::string because;  // a clause
  std::size_t count{0};
};

/// Why trials that count enter no estimate, most frequent reason first. Trials that a kind leaves
/// out by its rule, such as catch trials of a known guess rate, have no reason; adjustments,
/// pursuits and reaches count their own.
std::vector<UnusedTrials> unused_trials(const TrialsData& data, const TrialsPlan& plan);

}  // namespace haptrial::analysis::trials
