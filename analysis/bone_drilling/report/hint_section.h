#pragma once

#include <span>
#include <string>
#include <vector>

#include "analysis/bone_drilling/metrics/metrics.h"
#include "analysis/bone_drilling/report/hint_findings.h"
#include "analysis/bone_drilling/report/with_without.h"
#include "analysis/document/document.h"

namespace haptrial::analysis::drilling {

/// Change of one quantity by hints.
struct HintEffect {
  std::string name;  // "hint_rate", or a metric's
  std::string title;
  std::string unit;
  WithWithout effect;                   // participants' means with hints less those without
  Defined<double> holm{Undefined{""}};  // its p among all quantities
};

/// Hints a minute of drilling, which count whether they were shown or not, and the metrics that
/// hints are about. Empty unless some procedures were with hints and others without.
std::vector<HintEffect> hint_effects(std::span<const HintProcedure> hints,
                                     std::span<const ProcedureSummary> summaries);

/// Hints in a report: by condition and kind, and what they changed. Nothing where none are given.
/// @param simulated  the participants are programs
void add_hint_section(Document& document, std::span<const HintProcedure> hints,
                      std::span<const HintEffect> effects, bool simulated);

/// Lines for the end of the command, without "Simulated".
std::vector<std::string> hint_lines(std::span<const HintProcedure> hints,
                                    std::span<const HintEffect> effects);

}  // namespace haptrial::analysis::drilling
