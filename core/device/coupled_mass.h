#pragma once

#include "core/device/handle_physics.h"

namespace haptrial::device {

/// The defaults are near a handle in a relaxed hand, critically damped.
struct CoupledMassParameters {
  double mass{1.0};         // m > 0 [kg]
  double stiffness{400.0};  // k >= 0 [N/m]
  double damping{40.0};     // b >= 0 [N·s/m]
};

/// A point mass that a spring and a damper couple to an anchor that somebody moves:
///
///     m dv/dt = F_motor + F_press - k (p - p_anchor) - b v
///
/// Symplectic Euler rule: stable for a step below 2 sqrt(m / k) without damping.
class CoupledMass final : public HandlePhysics {
 public:
  /// @param start  of mass and anchor [m]
  /// @throws std::invalid_argument when a parameter is out of its bounds.
  explicit CoupledMass(const CoupledMassParameters& parameters,
                       const Eigen::Vector3d& start = Eigen::Vector3d::Zero());

  PointState step(const Eigen::Vector3d& motor_force, double dt) noexcept override;
  PointState state() const noexcept override { return state_; }

  const Eigen::Vector3d& anchor() const noexcept { return anchor_; }
  void set_anchor(const Eigen::Vector3d& anchor) noexcept { anchor_ = anchor; }    // [m]
  void set_press_force(const Eigen::Vector3d& force) noexcept { press_ = force; }  // [N]

 private:
  CoupledMassParameters parameters_;
  PointState state_;
  Eigen::Vector3d anchor_;
  Eigen::Vector3d press_{Eigen::Vector3d::Zero()};
};

}  // namespace haptrial::device
