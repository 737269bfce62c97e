#pragma once

#include <span>
#include <string>

#include "analysis/bone_drilling/metrics/metrics.h"
#include "analysis/document/finding.h"

namespace haptrial::analysis::drilling {

/// Whether any procedure could warm bone or open a vessel.
bool has_field(std::span<const ProcedureSummary> procedures);

/// Heat and blood: a row for each procedure that could have either. Described, not tested: the
/// constants of the heat are assumed. Without values where no procedure has a field.
FindingList field_findings(std::span<const ProcedureSummary> procedures);

/// A row for each such procedure.
std::string field_csv(std::span<const ProcedureSummary> procedures);

}  // namespace haptrial::analysis::drilling
