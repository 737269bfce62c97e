#pragma once

#include <string>
#include <vector>

#include "analysis/bone_drilling/report/validity_result.h"

namespace haptrial::analysis::drilling {

/// The results in a few lines, for the command and the head of the report.
std::vector<std::string> summary_lines(const ValidityResult& result);

}  // namespace haptrial::analysis::drilling
