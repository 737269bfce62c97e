#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "analysis/quality/timing.h"
#include "analysis/quality/tracking.h"
#include "core/record/rows/session_types.h"

namespace haptrial::analysis {

/// A test pass that has no score, and why.
struct Exclusion {
  std::string subject;
  std::int32_t trial{0};
  std::string reason;
};

/// Facts of one session file besides its scores.
struct SessionSummary {
  std::string file;  // name without its folder
  record::SessionInfo info;
  std::size_t test_passes{0};  // in the file, scored or not
  std::size_t scored{0};
  TrackingSummary tracking;  // over all completed passes, training and test
  LoopTiming timing;
};

}  // namespace haptrial::analysis
