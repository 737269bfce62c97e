#pragma once

#include <span>
#include <string>

#include "analysis/bone_drilling/validity/validity_findings.h"

namespace haptrial::analysis::drilling {

/// Everything that the report prints, as numbers. What is not defined is
/// {"not_defined": "because ..."}. Equal input gives equal bytes.
std::string validity_json(const Validity& v, std::span<const ProcedureSummary> procedures);

}  // namespace haptrial::analysis::drilling
