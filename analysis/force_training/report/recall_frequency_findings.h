#pragma once

#include <string>
#include <vector>

#include "analysis/document/figure.h"
#include "analysis/document/finding.h"
#include "analysis/force_training/score/score.h"
#include "analysis/force_training/study/recall_frequency.h"

namespace haptrial::analysis {

/// Gain, phase and coherence of recalled forces by frequency and condition, their tests and
/// figures; an empty list if there are no bands.
/// @param simulated  figures say so
FindingList recall_frequency_findings(const Defined<std::vector<RecallBand>>& frequencies,
                                      bool simulated);

/// Two curves and what their alignment made of them: the target, the applied curve as it was and as
/// it is warped, and lines between some of the paired samples. Source: Morris 2006, Figures 26, 27.
/// @param unit  of the values, "N"; empty: none is shown.
Figure recall_figure(const RecallDetail& recall, const std::string& unit);

}  // namespace haptrial::analysis
