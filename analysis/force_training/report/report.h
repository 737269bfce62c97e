#pragma once

#include <vector>

#include "analysis/document/document.h"
#include "analysis/force_training/study/study_result.h"

namespace haptrial::analysis {

/// Report of a study: design and exclusions, results, tests, pictures, quality, methods. Equal
/// input gives an equal document. @param drawings  outlive the document
Document study_report(const StudyResult& study, const std::vector<Drawing>& drawings);

}  // namespace haptrial::analysis
