#pragma once

#include <Eigen/Core>

#include "core/control/handle_loop.h"

namespace haptrial::control {

/// How much of a damper the hand of the moment carries.
///
/// Damping by a late velocity feeds energy into a light hand instead of taking it out: the handle
/// then oscillates at 20 Hz and more, where no hand moves by itself. The governor watches the
/// handle's velocity in that band. It begins with the damping that the bare handle carries and
/// raises it to b within half a second. Where b |v_band| passes 1 N, and v_band is a good
/// part of all the movement there is, the damping falls again within milliseconds and rises when
/// the handle is quiet. Where the oscillation comes back on the way up, damping stays at 0.7 of
/// what it had reached and is tried anew only slowly. So a heavy hand has all of b, a light one
/// what it carries, and a handle that is let go is quiet after a few periods.
/// docs/algorithms/every-hand.md has the figures.
///
/// Servo thread: no allocation, lock, I/O or throw.
class DampingGovernor {
 public:
  /// @param damping  that is wanted, b >= 0 [N·s/m]
  /// @throws std::invalid_argument where a parameter is out of its bounds.
  DampingGovernor(double damping, const HandleLoop& loop);

  /// @param velocity  of the handle along the axes that are damped, 0 along the others [m/s];
  ///                  counts as 0 where it is not finite
  /// @returns the share of b to use on this tick, least() to 1.
  double share(const Eigen::Vector3d& velocity) noexcept;

  /// What the bare handle carries, as a share of b.
  double least() const noexcept { return least_; }

 private:
  void watch(const Eigen::Vector3d& velocity) noexcept;

  double damping_;
  double period_;
  double least_;
  double high_gain_;
  double low_gain_;
  double band_fade_;
  double speed_fade_;
  double share_;
  double ceiling_{1.0};
  bool begun_{false};
  bool quiet_{true};
  bool fell_{false};             // since damping was whole, or since the beginning
  double band_amplitude_{0.0};   // of v_band, falling slowly [m/s]
  double speed_amplitude_{0.0};  // of the velocity [m/s]
  Eigen::Vector3d slow_[2]{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};  // [m/s]
  Eigen::Vector3d band_{Eigen::Vector3d::Zero()};                              // [m/s]
};

}  // namespace haptrial::control
