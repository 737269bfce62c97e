#pragma once

#include <Eigen/Core>

#include "core/base/point_state.h"
#include "core/control/tutoring/tutoring_law.h"

namespace haptrial::control {

struct WaveParameters {
  double impedance{5.0};    // b > 0 of the line [N·s/m]
  double correction{0.02};  // of the drift in place that is undone a tick, 0 to 1
};

/// One end of a line of wave variables, as the other way to keep a coupling passive: what goes over
/// the network is not velocity and force but
///
///     u = (b v + f) / sqrt(2 b),  w = (b v - f) / sqrt(2 b),  f · v = (u² - w²) / 2
///
/// so a delay stores energy and cannot make any (Niemeyer and Slotine 1991). v is the velocity of a
/// reference that the law's spring and damper hold the tool to, f what pulls at the reference. A
/// wave that is lost counts as zero; each wave is to be used once.
///
/// Velocities alone drift apart. The reference is moved towards the partner's place, which is sent
/// beside the waves, by at most `correction` of the distance a tick, and only so far as the energy
/// pays that the damper has taken.
///
/// Servo thread: no allocation, lock, I/O or throw.
class WavePort {
 public:
  /// @param start  of the reference, in W [m]
  /// @throws std::invalid_argument where the impedance is not above 0 or the gains are negative
  WavePort(const WaveParameters& parameters, const TutoringGains& gains,
           const Eigen::Vector3d& start = Eigen::Vector3d::Zero());

  /// One tick. @param incoming  the partner's wave [sqrt(W)]; zero where none came
  /// @param share  of the law's gains, 0 to 1: with 0 the wave goes back as it came
  /// @returns the force on the own tool, in W [N]
  Eigen::Vector3d step(const Eigen::Vector3d& incoming, const PointState& own, double dt,
                       double share = 1.0) noexcept;
  /// Without a link: the reference goes with the own tool, and nothing is on the line.
  void let_go(const Eigen::Vector3d& own) noexcept;
  /// The wave to send [sqrt(W)], after step().
  const Eigen::Vector3d& outgoing() const noexcept { return outgoing_; }
  /// Moves the reference. @param partner  the place it should have, in W [m]
  void correct(const Eigen::Vector3d& partner, const Eigen::Vector3d& own) noexcept;

  const PointState& reference() const noexcept { return reference_; }
  double into_line() const noexcept { return into_line_; }  // in all, f · v dt [J]
  double budget() const noexcept { return budget_; }        // for corrections [J]

 private:
  WaveParameters p_;
  TutoringGains gains_;
  PointState reference_;
  Eigen::Vector3d outgoing_{Eigen::Vector3d::Zero()};
  double into_line_{0.0};
  double budget_{0.0};
};

}  // namespace haptrial::control
