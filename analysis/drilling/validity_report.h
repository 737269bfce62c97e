#pragma once

#include <vector>

#include "analysis/document.h"
#include "analysis/drilling/validity_result.h"

namespace haptrial::analysis::drilling {

/// What a report of a study with simulated participants or raters says wherever it says a result.
extern const char* const kRehearsal;

/// The whole report. @param drawings  outlive the document
Document validity_report(const ValidityResult& result, const std::vector<Drawing>& drawings);

}  // namespace haptrial::analysis::drilling
