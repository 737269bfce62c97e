#pragma once

#include <span>

#include "core/realtime/histogram.h"
#include "core/record/rows/session_types.h"
#include "experiments/control/session_control.h"

namespace haptrial::experiments {

/// "idle", "approach", "wait", "run" or "return".
const char* name_of(record::Stage stage);

/// Status of a running session for the console, from its records. Session's thread.
class LiveStatus {
 public:
  /// How late the ticks of these records were, against the earliest of all; keeps the last one.
  /// @param period_ns  nominal
  void follow(std::span<const record::Sample> samples, double period_ns);
  /// Fills position, forces, stage and lateness.
  void fill(SessionStatus& status) const;

 private:
  record::Sample last_;
  realtime::DurationHistogram lateness_;
  double earliest_ns_{0.0};  // of time minus deadline
  double before_ns_{0.0};    // that of the sample before
  bool started_{false};
};

}  // namespace haptrial::experiments
