#pragma once

#include <vector>

#include "analysis/bone_drilling/checklist/checklist_sheet.h"
#include "analysis/bone_drilling/metrics/metrics.h"
#include "analysis/document/finding.h"
#include "analysis/statistics/relation/intraclass.h"

namespace haptrial::analysis::drilling {

/// A checklist and what raters gave by it.
struct CheckedStudy {
  Checklist checklist;
  std::vector<CheckedRow> rows;
};

/// Agreement of the raters in the total, over the procedures that each of them checked.
Defined<Intraclass> checklist_agreement(const CheckedStudy& study);

/// Share of pairs of raters who gave an item of a procedure the same points; nothing without pairs.
std::optional<double> same_points(const CheckedStudy& study, std::size_t item);

/// Totals by group, each item, and how raters and measures agree. Without values where nobody
/// filled in a checklist.
FindingList checklist_findings(const CheckedStudy& study,
                               const std::vector<ProcedureSummary>& procedures,
                               const std::vector<std::string>& groups);

}  // namespace haptrial::analysis::drilling
