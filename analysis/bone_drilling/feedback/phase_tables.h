#pragma once

#include <optional>
#include <string>

#include "analysis/bone_drilling/feedback/findings.h"

namespace haptrial::analysis::drilling {

/// A section of a page, as HTML: the phases of a procedure as a band over its time, and the time in
/// each beside the experts' range. Empty where the procedure is not divided.
std::string phase_section(const Findings& findings, const Experts& experts);

/// The smallest, median and largest time of the experts' procedures in a phase [s].
std::optional<SafeRange> experts_time(const Experts& experts, const std::string& phase);

}  // namespace haptrial::analysis::drilling
