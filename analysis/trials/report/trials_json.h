#pragma once

#include <string>

#include "analysis/trials/psychometric/trials_result.h"

namespace haptrial::analysis::trials {

/// Everything that the report prints, as numbers. What is not defined is
/// {"not_defined": "because ..."}; what is not known is null. Equal input gives equal bytes.
std::string results_json(const TrialsResult& result);
/// The part "reaching" of it.
std::string reaching_json(const ReachingResult& reaching);

}  // namespace haptrial::analysis::trials
