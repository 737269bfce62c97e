#pragma once

#include <span>
#include <string>

#include "analysis/bone_drilling/report/validity_result.h"
#include "analysis/document/finding.h"

namespace haptrial::analysis::drilling {

/// Everything that the report prints, as numbers. What is not defined is
/// {"not_defined": "because ..."}. Equal input gives equal bytes.
std::string validity_json(const Validity& v, std::span<const ProcedureSummary> procedures);
/// The same with what Figure 20 shows: force and speed by distance to the structure.
/// @param own  findings of a program of one's own
std::string validity_json(const ValidityResult& result, const std::vector<FindingList>& own = {});

}  // namespace haptrial::analysis::drilling
