#pragma once

#include <span>

#include "core/realtime/histogram.h"
#include "core/realtime/latest_value.h"
#include "core/record/session_types.h"
#include "core/stimulus/observer.h"
#include "experiments/session_control.h"

namespace haptrial::experiments {

/// What the servo thread shows of itself for the console, and what the session's thread makes of it.
class LiveStatus final : public stimulus::Observer {
 public:
  /// Servo thread: keeps the latest tick.
  void observe(const stimulus::Presentation& seen, const Eigen::Vector3d& device_force,
               double dt) noexcept override;

  /// Session's thread: how late the ticks of these records were, against the earliest of all.
  /// @param period_ns  nominal
  void follow(std::span<const record::Sample> samples, double period_ns);
  /// Session's thread: fills position, forces, stage and lateness.
  void fill(SessionStatus& status);

 private:
  realtime::LatestValue<stimulus::Presentation> latest_;
  stimulus::Presentation seen_;
  realtime::DurationHistogram lateness_;
  double earliest_ns_{0.0};  // of time minus deadline
  bool started_{false};
};

}  // namespace haptrial::experiments
