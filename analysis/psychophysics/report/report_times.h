#pragma once

#include "analysis/document/finding.h"
#include "analysis/psychophysics/study/trials_result.h"

namespace haptrial::analysis::trials {

/// Every participant's times and wrong answers under each condition.
FindingTable time_findings(const TrialsResult& result);

/// Adds how times were taken and put together.
void add_time_methods(Document& document, const TrialsPlan& plan);

}  // namespace haptrial::analysis::trials
