#include "experiments/live_status.h"

namespace haptrial::experiments {
namespace {

const char* stage_of(const stimulus::Presentation& seen) {
  if (!seen.show_trajectory) {
    return "idle";
  }
  if (seen.progress <= 0.0) {
    return "approach";
  }
  return seen.progress < 1.0 ? "run" : "return";
}

}  // namespace

void LiveStatus::observe(const stimulus::Presentation& seen, const Eigen::Vector3d&,
                         double) noexcept {
  latest_.write(seen);
}

void LiveStatus::follow(std::span<const record::Sample> samples, double period_ns) {
  for (const record::Sample& sample : samples) {
    const double late = static_cast<double>(sample.time_ns) -
                        static_cast<double>(sample.sequence) * period_ns;
    if (!started_ || late < earliest_ns_) {
      earliest_ns_ = late;
      started_ = true;
    }
    lateness_.add(static_cast<std::int64_t>(late - earliest_ns_));
  }
}

void LiveStatus::fill(SessionStatus& status) {
  latest_.read(seen_);
  status.position = seen_.tool;
  status.target_force = seen_.target_force;
  status.applied_force = seen_.applied_force;
  status.stage = stage_of(seen_);
  if (lateness_.count() > 0) {
    status.lateness_median_us = 1e-3 * lateness_.percentile(50.0);
    status.lateness_99_us = 1e-3 * lateness_.percentile(99.0);
    status.lateness_worst_us = 1e-3 * lateness_.max();
  }
}

}  // namespace haptrial::experiments
