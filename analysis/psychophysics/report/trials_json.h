#pragma once

#include <string>

#include "analysis/document/finding.h"
#include "analysis/psychophysics/study/trials_result.h"

namespace haptrial::analysis::trials {

/// Everything that the report prints, as numbers. What is not defined is
/// {"not_defined": "because ..."}; what is not known is null. Equal input gives equal bytes.
/// @param own  findings of a program of one's own
std::string results_json(const TrialsResult& result, const std::vector<FindingList>& own);
/// The part "reaching" of it.
std::string reaching_json(const ReachingResult& reaching);

}  // namespace haptrial::analysis::trials
