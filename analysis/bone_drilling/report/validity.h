#pragma once

#include <optional>
#include <span>
#include <vector>

#include "analysis/bone_drilling/metrics/metrics.h"
#include "analysis/bone_drilling/report/ratings.h"
#include "analysis/bone_drilling/report/validity_findings.h"

namespace haptrial::analysis::drilling {

/// The statistics of a construct-validity study. Source: Morris 2006, §3.3 and §3.5.
/// @param procedures  with the scores of add_region_scores(), which gave `regions`
/// @param region_test  of the same procedures; nothing: the region's contrast has no p
/// @throws InputError for a procedure in a group that the plan does not name, an expert group that
/// is none of the groups, a participant in two groups, or ratings of a procedure that is not there.
Validity validity(std::span<const ProcedureSummary> procedures,
                  std::span<const RegionScores> regions, const std::vector<Rating>& ratings,
                  const ValidityPlan& plan,
                  const std::optional<RegionLabelTest>& region_test = std::nullopt);

}  // namespace haptrial::analysis::drilling
