#pragma once

#include <span>

#include "analysis/quality/trial_quality.h"
#include "core/record/rows/session_types.h"

namespace haptrial::analysis {

/// All that the samples of a run tell about it; damping and frames stand elsewhere in the file.
/// @param run   Stage::kRun of one pass, in order
/// @param rate  of the loop [Hz]
RunQuality run_quality(std::span<const record::Sample> run, double rate);

/// The share of the screen's refreshes from `begin` to `end` [ns] that showed no new picture; empty
/// where no frame was recorded then. @param frames  in order of time
std::optional<double> dropped_frames(std::span<const record::FrameRow> frames, std::int64_t begin,
                                     std::int64_t end);

}  // namespace haptrial::analysis
