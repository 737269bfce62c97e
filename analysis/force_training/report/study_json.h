#pragma once

#include <string>

#include "analysis/document/finding.h"
#include "analysis/force_training/study/study_result.h"

namespace haptrial::analysis {

/// Everything that the report prints, as numbers: means with intervals, the analyses of variance,
/// t-tests, Table 1, learning, tracking, timing, exclusions, parameters, and `simulated`. What is
/// not defined is {"not_defined": "because ..."}, never null or NaN. Equal input gives equal bytes.
/// @param own  findings of a program of one's own
std::string statistics_json(const StudyResult& study, const std::vector<FindingList>& own = {});

}  // namespace haptrial::analysis
