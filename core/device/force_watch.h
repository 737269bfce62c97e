#pragma once

#include <Eigen/Core>

#include "core/control/swing_counter.h"
#include "core/device/fault.h"

namespace haptrial::device {

/// Finds forces that go wrong though each alone is allowed.
///
/// - Oscillation at the limit: along one axis the force turned back at least five times, each time
///   by more than half of the limit, from or to more than 0.7 of it, and at most 80 ms after the
///   time before, over 65 ms or more. So 6 Hz and more are found, from 22 Hz on within 120 ms.
/// - Any oscillation: along one axis the force swings by 2 N or more at 15 Hz or more for 0.2 s, it
///   does not die away, and no stimulus accounts for it (SwingCounter).
/// - Saturation: for longer than `longest` the force did not leave the limit.
///
/// Servo thread: no allocation, lock, I/O or throw.
class ForceWatch {
 public:
  /// @param limit    of the force > 0 [N]
  /// @param longest  at the limit > 0 [s]
  ForceWatch(double limit, double longest) noexcept;

  /// @param force     that is about to be given [N]
  /// @param stimulus  the part of it that alternates by itself [N]
  /// @returns kOscillation, kSaturation or kNone.
  Fault look(const Eigen::Vector3d& force, const Eigen::Vector3d& stimulus, double dt) noexcept;

  void reset() noexcept { *this = ForceWatch(limit_, longest_); }

 private:
  double limit_;
  double longest_;
  double saturated_for_{0.0};  // [s]
  control::SwingCounter at_limit_;
  control::SwingCounter swings_;
};

}  // namespace haptrial::device
