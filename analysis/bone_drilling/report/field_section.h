#pragma once

#include <span>
#include <string>

#include "analysis/bone_drilling/metrics/metrics.h"
#include "analysis/document/document.h"

namespace haptrial::analysis::drilling {

/// Whether any procedure could warm bone or open a vessel.
bool has_field(std::span<const ProcedureSummary> procedures);

/// Heat and blood in a report: a row for each procedure that could have either. Described, not
/// tested: the constants of the heat are assumed. Nothing where no procedure has a field.
/// @param simulated  the participants are programs
void add_field_section(Document& document, std::span<const ProcedureSummary> procedures,
                       bool simulated);

/// A row for each such procedure.
std::string field_csv(std::span<const ProcedureSummary> procedures);

}  // namespace haptrial::analysis::drilling
