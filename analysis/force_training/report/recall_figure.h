#pragma once

#include "analysis/document/figure.h"
#include "analysis/force_training/score/score.h"

namespace haptrial::analysis {

/// Two curves and what their alignment made of them: the target, the applied curve as it was and as
/// it is warped, and lines between some of the paired samples. Source: Morris 2006, Figures 26, 27.
/// @param unit  of the values, "N"; empty: none is shown.
Figure recall_figure(const RecallDetail& recall, const std::string& unit);

}  // namespace haptrial::analysis
