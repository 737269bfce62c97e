#pragma once

#include <Eigen/Core>

#include "core/control/gain_shares.h"
#include "core/control/handle_loop.h"
#include "core/control/swing_counter.h"

namespace haptrial::control {

/// Keeps a handle calm whatever acts on it.
///
/// A force that follows late or held readings feeds energy into a light hand instead of taking it
/// out: the handle oscillates at 8 Hz and more. The guard counts the turns of the force that the
/// program commands. From the third turn of 1.5 N or more on (the noise of an encoder of 10 um in
/// the source's plane is 1.2 N), or from the second of 2 N or more, it gives way by g, further with
/// each turn:
///
///     share of damping    s_b = exp(-g)
///     share of stiffness  s_k = exp(-(g - 3)) above g = 3, else 1
///     calming damper      f = -max(1 - s_b, c) b_0 v_h
///
/// so that damping and virtual mass go first, stiffness last, and in place of both comes the
/// damping b_0 that the bare handle carries (damping_of_bare_handle()), less if a step of the
/// encoder would make more than 0.25 N of it, on the part v_h of the velocity above 4 Hz, so that
/// it does not hold back a hand that moves. What dies away by itself, as after a knock, is only
/// damped. Turns that are slower than those of 14 Hz may be a tremor, and a damper still takes
/// energy from them: they bring in the calming damper (c = 1) and take nothing away, unless they
/// reach 4 N, or 3 N twice, and do not die away. When it has become quiet, the gains come back
/// within a second. Where the oscillation then comes back, g stays a little above that value, which
/// is tried anew only slowly. So a heavy hand has all the gains, a light one what it carries.
/// docs/algorithms/every-hand.md has the figures.
///
/// Servo thread, all but the constructor: no allocation, lock, I/O or throw.
class HandleGuard {
 public:
  /// @throws std::invalid_argument where a parameter is out of its bounds.
  explicit HandleGuard(const HandleLoop& loop);

  /// @param velocity   of the handle [m/s]; counts as 0 where it is not finite
  /// @param force      that was commanded on the tick before [N]
  /// @param accounted  the part of it that alternates by itself (SwingCounter) [N]
  /// @param dt         since the tick before [s]
  /// @returns the shares to use on this tick.
  const GainShares& watch(const Eigen::Vector3d& velocity, const Eigen::Vector3d& force,
                          const Eigen::Vector3d& accounted, double dt) noexcept;

  /// The force of the calming damper on this tick [N].
  const Eigen::Vector3d& calming() const noexcept { return calming_; }

 private:
  GainShares wanted_shares() const noexcept;
  bool settled() const noexcept;
  bool oscillates(const SwingCounter::Alternation& train) noexcept;
  void give_way(const SwingCounter::Alternation& train) noexcept;
  void recover(double dt) noexcept;
  void calm(const Eigen::Vector3d& velocity, double dt) noexcept;

  double calm_damping_;  // b_0 [N·s/m]
  SwingCounter turns_;
  GainShares shares_;
  double given_{0.0};                                 // g
  double calm_{0.0};                                  // wanted c
  double calm_now_{0.0};                              // c
  double too_little_{0.0};                            // g at which the oscillation came back
  double quiet_for_{1.0};                             // [s]
  int still_{0};                                      // turns that did not die away
  int slow_turns_{0};                                 // large ones that did not die away
  bool recovers_{false};                              // has become quiet after it had given way
  double remembered_for_{0.0};                        // since all the gains are back [s]
  Eigen::Vector3d slow_{Eigen::Vector3d::Zero()};     // velocity below 4 Hz [m/s]
  Eigen::Vector3d calming_{Eigen::Vector3d::Zero()};  // [N]
};

}  // namespace haptrial::control
