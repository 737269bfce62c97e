#include "core/device/handle_physics.h"

#include <stdexcept>

namespace haptrial::device {

CoupledMass::CoupledMass(const CoupledMassParameters& parameters, const Eigen::Vector3d& start)
    : parameters_(parameters), state_{start, Eigen::Vector3d::Zero()}, anchor_(start) {
  if (!(parameters.mass > 0.0 && parameters.stiffness >= 0.0 && parameters.damping >= 0.0)) {
    throw std::invalid_argument(
        "CoupledMass: the mass must be above 0, stiffness and damping at least 0");
  }
}

PointState CoupledMass::step(const Eigen::Vector3d& motor_force, double dt) noexcept {
  const auto& p = parameters_;
  const Eigen::Vector3d force = motor_force + press_ - p.stiffness * (state_.position - anchor_) -
                                p.damping * state_.velocity;
  state_.velocity += dt / p.mass * force;
  state_.position += dt * state_.velocity;
  return state_;
}

}  // namespace haptrial::device
