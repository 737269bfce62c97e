#pragma once

#include <Eigen/Core>

#include "core/base/point_state.h"
#include "core/control/gain_shares.h"

namespace haptrial::tutoring {

/// How strongly one hand is led by another. Source: Morris 2006, §3.4.1.
struct TutoringGains {
  double stiffness{80.0};   // K_p >= 0 [N/m]
  double damping{2.0};      // D >= 0 [N·s/m]
  double force_share{1.0};  // of the partner's force that is played, 0 to 1
};

/// One side's knowledge of the other.
struct Partner {
  PointState tool;                                 // in W
  Eigen::Vector3d force{Eigen::Vector3d::Zero()};  // of its world on its tool, in W [N]
};

/// Spring and damper towards the partner's tool:
///
///     f = K_p (p_partner - p) + D (v_partner - v)
///
/// The source prints the spring with the other sign, which would push away.
/// @param shares  of K_p and D that are used
/// @returns zero where an input is not finite. Servo thread.
Eigen::Vector3d coupling_force(const TutoringGains& gains, const PointState& partner,
                               const PointState& own,
                               const control::GainShares& shares = {}) noexcept;

/// Shares of the lead, seen from one side.
struct Lead {
  double partner{1.0};    // the partner's authority over this side, 0 to 1
  double felt_back{0.0};  // of the coupling that is felt where this side leads, 0 to 1
};

/// Force that one side feels:
///
///     (1 - a) f_own + a s f_partner + max(a, felt_back) f_coupling
///
/// with a the partner's authority and s the force share; a = 1 is the law of the source.
/// @param own_force  of the own world on the own tool, in W [N]
/// @param shares     of K_p and D that are used
/// @returns zero where an input is not finite. Servo thread.
Eigen::Vector3d tutoring_force(const TutoringGains& gains, const Lead& lead, const Partner& partner,
                               const PointState& own, const Eigen::Vector3d& own_force,
                               const control::GainShares& shares = {}) noexcept;

/// Time over which a played motion that waits or is over comes to rest, as a damper would strike
/// the hand if its velocity changed in a tick [s].
inline constexpr double kTimeToRest = 0.08;

/// The authority as it goes from one hand to the other: at an even rate, never by a step.
class Handover {
 public:
  /// @param seconds  from 0 to 1 > 0
  explicit Handover(double seconds, double share = 0.0) noexcept
      : rate_(1.0 / seconds), share_(share), asked_(share) {}
  void ask(double share) noexcept;  // limited to 0 to 1; NaN is 0
  double step(double dt) noexcept;  // a tick later. Servo thread
  double share() const noexcept { return share_; }

 private:
  double rate_;  // [1/s]
  double share_;
  double asked_;
};

/// The stiffest coupling over a link that is not made passive, about: K < b / (T / 2 + T_d).
/// @param damping  of hand, device and law together [N·s/m]  @param period  of the loop [s]
/// @param delay    there and back [s]
double stiffest_over_delay(double damping, double period, double delay) noexcept;

}  // namespace haptrial::tutoring
