#pragma once

#include <Eigen/Core>

#include "core/base/point_state.h"

namespace haptrial::device {

/// Load on a virtual device's handle: it moves the handle under the motors' force.
class HandlePhysics {
 public:
  virtual ~HandlePhysics() = default;
  /// Advances by `dt` [s] under `motor_force` [N] in W, held over the step.
  /// @returns the true handle state at the end. Servo thread.
  virtual PointState step(const Eigen::Vector3d& motor_force, double dt) noexcept = 0;
  virtual PointState state() const noexcept = 0;
};

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
