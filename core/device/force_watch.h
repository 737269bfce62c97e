#pragma once

#include <Eigen/Core>
#include <array>

#include "core/device/fault.h"

namespace haptrial::device {

/// Finds forces that go wrong though each alone is allowed.
///
/// - Oscillation: along one axis the force turned back at least four times, each time by more than
///   half of the limit, from or to more than 0.7 of it, and at most 80 ms after the time before,
///   over 73 ms or more. So 6 Hz and more are found, from 22 Hz on within 100 ms. A burst that is
///   over sooner is none.
/// - Saturation: for longer than `longest` the force did not leave the limit.
///
/// Servo thread: no allocation, lock, I/O or throw.
class ForceWatch {
 public:
  /// @param limit    of the force > 0 [N]
  /// @param longest  at the limit > 0 [s]
  ForceWatch(double limit, double longest) : limit_(limit), longest_(longest) {}

  /// @param force  that is about to be given [N]
  /// @returns kOscillation, kSaturation or kNone.
  Fault look(const Eigen::Vector3d& force, double dt) noexcept;

  void reset() noexcept { *this = ForceWatch(limit_, longest_); }

 private:
  /// One component of the force: where it turned back last.
  struct Axis {
    double extreme{0.0};      // [N]
    int direction{0};         // +1 rising, -1 falling; 0: not known yet
    double first_turn{0.0};   // of those that follow one another [s]
    double latest_turn{0.0};  // [s]
    int turns{0};             // that follow one another
  };
  bool turns_too_often(Axis& axis, double force) const noexcept;

  double limit_;
  double longest_;
  double time_{0.0};           // [s]
  double saturated_for_{0.0};  // [s]
  std::array<Axis, 3> axes_;
};

}  // namespace haptrial::device
