#pragma once

#include <span>
#include <string>

#include "analysis/bone_drilling/report/validity_findings.h"
#include "analysis/bone_drilling/report/validity_result.h"

namespace haptrial::analysis::drilling {

/// Everything that the report prints, as numbers. What is not defined is
/// {"not_defined": "because ..."}. Equal input gives equal bytes.
std::string validity_json(const Validity& v, std::span<const ProcedureSummary> procedures);
/// The same with what Figure 20 shows: force and speed by distance to the structure.
std::string validity_json(const ValidityResult& result);

}  // namespace haptrial::analysis::drilling
