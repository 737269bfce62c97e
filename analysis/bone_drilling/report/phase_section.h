#pragma once

#include <span>
#include <string>

#include "analysis/bone_drilling/report/validity_result.h"
#include "analysis/document/finding.h"

namespace haptrial::analysis::drilling {

/// Whether procedures were divided into phases.
bool is_divided(const ValidityResult& result);

/// The time of each group in each phase and the order of the phases. Without values where
/// procedures were not divided.
FindingList phase_findings(const ValidityResult& result);

/// The table that read_phase_labels() reads, so that somebody may correct it and learn anew.
std::string phases_csv(std::span<const ProcedureSummary> procedures);

}  // namespace haptrial::analysis::drilling
