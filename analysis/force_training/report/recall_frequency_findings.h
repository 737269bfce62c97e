#pragma once

#include <vector>

#include "analysis/document/finding.h"
#include "analysis/force_training/study/recall_frequency.h"

namespace haptrial::analysis {

/// Gain, phase and coherence of recalled forces by frequency and condition, their tests and
/// figures; an empty list if there are no bands.
/// @param simulated  figures say so
FindingList recall_frequency_findings(const std::vector<RecallBand>& bands, bool simulated);

}  // namespace haptrial::analysis
