#include "core/subject/hand.h"

#include <algorithm>
#include <unsupported/Eigen/MatrixFunctions>

namespace haptrial::subject {

Hand::Hand(const HandParameters& parameters, double step, const Eigen::Vector3d& start)
    : yielding_(exact_step(axis_dynamics(parameters, true), step)),
      holding_(exact_step(axis_dynamics(parameters, false), step)),
      friction_(parameters.coulomb_friction) {
  for (int axis = 0; axis < 3; ++axis) {
    axes_[axis] << start[axis], 0.0, start[axis], 0.0, 0.0;
  }
}

Hand::ExactStep Hand::exact_step(const AxisDynamics& dynamics, double dt) {
  // exp of the system augmented by its held inputs gives both matrices at once.
  Eigen::Matrix<double, 7, 7> augmented = Eigen::Matrix<double, 7, 7>::Zero();
  augmented.topLeftCorner<5, 5>() = dynamics.system * dt;
  augmented.topRightCorner<5, 2>() = dynamics.input * dt;
  const Eigen::Matrix<double, 7, 7> flow = augmented.exp();
  return {flow.topLeftCorner<5, 5>(), flow.topRightCorner<5, 2>()};
}

PointState Hand::step(const Eigen::Vector3d& motor_force, double) noexcept {
  for (int axis = 0; axis < 3; ++axis) {
    const bool vertical = axis == 1;
    const ExactStep& exact = vertical && command_.holds_posture ? holding_ : yielding_;
    const double press = vertical ? -command_.press : 0.0;
    const Eigen::Vector2d input(motor_force[axis] + command_.force[axis], press);
    AxisState next = exact.state * axes_[axis] + exact.input * input;
    const double stopping = -next[1] / exact.input(1, 0);
    next += exact.input.col(0) * std::clamp(stopping, -friction_, friction_);
    axes_[axis] = next;
  }
  return state();
}

PointState Hand::state() const noexcept {
  return {{axes_[0][0], axes_[1][0], axes_[2][0]}, {axes_[0][1], axes_[1][1], axes_[2][1]}};
}

}  // namespace haptrial::subject
