#include "core/deformable/body/body_motion.h"

#include <Eigen/Geometry>
#include <utility>

namespace haptrial::deformable {

using Eigen::Vector3d;

BodyMotion::BodyMotion(std::vector<double> masses, PaddedPoints points,
                       std::span<const std::int32_t> held)
    : masses_(std::move(masses)),
      held_(masses_.size(), 0),
      positions_(std::move(points)),
      velocities_(positions_.size()),
      forces_(positions_.size()),
      external_(positions_.size()) {
  for (const std::int32_t vertex : held) {
    held_[static_cast<std::size_t>(vertex)] = 1;
  }
}

void BodyMotion::set_velocity(std::size_t vertex, const Vector3d& velocity) noexcept {
  if (!held(vertex)) {
    velocities_[vertex] = velocity;
  }
}

void BodyMotion::stop() noexcept {
  for (std::size_t v = 0; v < masses_.size(); ++v) {
    velocities_[v].setZero();
  }
}

void BodyMotion::adopt(const BodyMotion& before) noexcept {
  for (std::size_t v = 0; v < masses_.size(); ++v) {
    positions_[v] = before.positions_[v];
    velocities_[v] = before.velocities_[v];
  }
}

std::vector<Vector3d> BodyMotion::positions() const {
  std::vector<Vector3d> positions(masses_.size());
  copy_positions(positions);
  return positions;
}

void BodyMotion::copy_positions(std::span<Vector3d> to) const noexcept {
  for (std::size_t v = 0; v < masses_.size(); ++v) {
    to[v] = positions_[v];
  }
}

Vector3d BodyMotion::momentum() const {
  Vector3d sum = Vector3d::Zero();
  for (std::size_t v = 0; v < masses_.size(); ++v) {
    sum += masses_[v] * velocities_[v];
  }
  return sum;
}

Vector3d BodyMotion::angular_momentum() const {
  Vector3d sum = Vector3d::Zero();
  for (std::size_t v = 0; v < masses_.size(); ++v) {
    sum += masses_[v] * Vector3d(positions_[v]).cross(Vector3d(velocities_[v]));
  }
  return sum;
}

}  // namespace haptrial::deformable
