#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/bone_drilling/feedback/findings.h"

namespace haptrial::analysis::drilling {

/// Parts of a page about one procedure, as HTML.

/// The metrics that a page shows: all but those that need novices to compare with.
std::vector<MetricKind> shown_metrics();

/// Smallest, median and largest of some values; nothing of none.
std::optional<SafeRange> range_of(std::vector<double> values);

/// Smallest, median and largest value of a metric over the experts' procedures.
std::optional<SafeRange> experts_range(const Experts& experts, const std::string& metric);

/// Whether a value lies on the wrong side of all experts'; never for metrics of which nobody says
/// which side that is.
bool beyond_experts(const MetricKind& kind, double value, const SafeRange& experts);

std::string number_text(const std::optional<double>& value);

/// Which vital structures were opened, and when; empty: none was.
std::string injury_banners(const Findings& findings);
/// The main points in a few lines.
std::string summary_points(const Findings& findings, const Experts& experts);
std::string metrics_table(const Findings& findings, const Experts& experts);
/// Table by structure: the bone that was removed near it, and the shares hidden, too hard, too
/// fast.
std::string structures_table(const Findings& findings);
std::string injuries_table(const Findings& findings);
/// The removals with the most force for their distance from a structure.
std::string worst_table(const Findings& findings, const Experts& experts);
/// Force and speed over distance, structure by structure.
std::string near_plots(const Findings& findings, const Experts& experts);

}  // namespace haptrial::analysis::drilling
