#pragma once

#include <string>

#include "analysis/bone_drilling/feedback/findings.h"

namespace haptrial::analysis::drilling {

/// A section of a page, as HTML: how much of the planned cavity is removed, bone beyond it, bone
/// left over structures and the path of the tool, each beside the experts' range.
std::string achieved_section(const Findings& findings, const Experts& experts);

/// One of figures_of() by its column; nothing where it is not defined.
std::optional<double> achieved_value(const ProcedureSummary& summary, const std::string& column);

/// The smallest, median and largest of the experts' values.
std::optional<SafeRange> achieved_range(const Experts& experts, const std::string& column);

}  // namespace haptrial::analysis::drilling
