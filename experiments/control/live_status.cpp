#include "experiments/control/live_status.h"

#include "core/realtime/deadlines.h"

namespace haptrial::experiments {

const char* name_of(record::Stage stage) {
  switch (stage) {
    case record::Stage::kIdle:
      return "idle";
    case record::Stage::kApproach:
      return "approach";
    case record::Stage::kWait:
      return "wait";
    case record::Stage::kRun:
      return "run";
    case record::Stage::kReturn:
      return "return";
  }
  return "";
}

void LiveStatus::follow(std::span<const record::Sample> samples, double period_ns) {
  for (const record::Sample& sample : samples) {
    const double late =
        static_cast<double>(sample.time_ns) - static_cast<double>(sample.sequence) * period_ns;
    if (started_ && late - before_ns_ > realtime::Deadlines::kHopelesslyLateNs) {
      earliest_ns_ += late - before_ns_;  // after a suspension the deadlines are new
    }
    if (!started_ || late < earliest_ns_) {
      earliest_ns_ = late;
      started_ = true;
    }
    before_ns_ = late;
    lateness_.add(static_cast<std::int64_t>(late - earliest_ns_));
    last_ = sample;
  }
}

void LiveStatus::fill(SessionStatus& status) const {
  status.position = last_.position;
  status.target_force = last_.target_force;
  status.applied_force = last_.applied_force;
  status.force_on_hand = last_.force.norm();
  status.stage = name_of(last_.stage);
  if (lateness_.count() > 0) {
    status.lateness_median_us = 1e-3 * lateness_.percentile(50.0);
    status.lateness_99_us = 1e-3 * lateness_.percentile(99.0);
    status.lateness_worst_us = 1e-3 * lateness_.max();
  }
}

}  // namespace haptrial::experiments
