#pragma once

#include <string>

#include "analysis/document/finding.h"
#include "analysis/files/json_pieces.h"
#include "analysis/psychophysics/study/trials_result.h"

namespace haptrial::analysis::trials {

/// Everything that the report prints, as numbers. What is not defined is
/// {"not_defined": "because ..."}; what is not known is null. Equal input gives equal bytes.
/// @param own   findings of a program of one's own
/// @param take  is given the text in pieces, since it is as long as a study
void results_json(const TrialsResult& result, const std::vector<FindingList>& own,
                  const JsonPieces::Take& take);
/// The part "reaching" of it.
std::string reaching_json(const ReachingResult& reaching);

}  // namespace haptrial::analysis::trials
