#pragma once

#include <vector>

#include "analysis/bone_drilling/report/validity_result.h"
#include "analysis/document/document.h"

namespace haptrial::analysis::drilling {

/// Words with which a report of a study with simulated participants or raters marks each result.
extern const char* const kSimulatedValidity;

/// The whole report. @param drawings  outlive the document
Document validity_report(const ValidityResult& result, const std::vector<Drawing>& drawings);

}  // namespace haptrial::analysis::drilling
