#include "core/device/sensed_mount.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace haptrial::device {
namespace {

constexpr double kStill = 1e-6;  // [m/s]

double sign(double v) { return v > kStill ? 1.0 : v < -kStill ? -1.0 : 0.0; }

}  // namespace

SensedMount::SensedMount(const SensedMountParameters& parameters, std::uint64_t seed)
    : parameters_(parameters),
      random_(seed, "force sensor"),
      state_{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()} {
  if (!(parameters.mass > 0.0 && parameters.friction >= 0.0 && parameters.noise >= 0.0 &&
        parameters.added_mass >= 0.0)) {
    throw std::invalid_argument(
        "SensedMount: the mass must be above 0, friction, noise and added_mass at least 0");
  }
  path_.fill(state_.position);
  measured_.noise = parameters.noise;
}

void SensedMount::hold(const Eigen::Vector3d& position) noexcept {
  if (!held_) {
    held_ = true;
    path_.fill(position);
    state_ = {position, Eigen::Vector3d::Zero()};
  }
  goal_ = position;
}

PointState SensedMount::step(const Eigen::Vector3d& motor_force, double dt) noexcept {
  if (held_) {
    follow(motor_force, dt);
  } else {
    move_freely(motor_force, dt);
  }
  return state_;
}

// Derivatives at the newest position, of third order in dt.
void SensedMount::follow(const Eigen::Vector3d& motor_force, double dt) noexcept {
  measured_.time += dt;
  std::rotate(path_.begin(), path_.end() - 1, path_.end());
  path_[0] = goal_;
  const auto& x = path_;
  state_.position = goal_;
  state_.velocity = (11.0 * x[0] - 18.0 * x[1] + 9.0 * x[2] - 2.0 * x[3]) / (6.0 * dt);
  const Eigen::Vector3d a =
      (35.0 * x[0] - 104.0 * x[1] + 114.0 * x[2] - 56.0 * x[3] + 11.0 * x[4]) / (12.0 * dt * dt);
  for (int axis = 0; axis < 3; ++axis) {
    measured_.force[axis] = motor_force[axis] - parameters_.friction * sign(state_.velocity[axis]) -
                            parameters_.mass * a[axis] + parameters_.noise * random_.normal();
  }
}

void SensedMount::move_freely(const Eigen::Vector3d& motor_force, double dt) noexcept {
  const double mass = parameters_.mass + (carries_ ? parameters_.added_mass : 0.0);
  const double held_back = parameters_.friction / mass * dt;  // change of velocity [m/s]
  for (int axis = 0; axis < 3; ++axis) {
    const double before = state_.velocity[axis];
    const double pushed = before + motor_force[axis] / mass * dt;
    const double after =
        std::abs(pushed) > held_back ? pushed - std::copysign(held_back, pushed) : 0.0;
    state_.velocity[axis] = after;
    state_.position[axis] += 0.5 * (before + after) * dt;
    measured_.force[axis] = 0.0;
  }
}

bool SensedMount::read(MeasuredForce& measured) noexcept {
  if (!held_) {
    return false;
  }
  measured = measured_;
  return true;
}

}  // namespace haptrial::device
