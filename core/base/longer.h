#pragma once

#include <Eigen/Core>

namespace haptrial {

/// Whether a vector is longer than `limit` >= 0: on every tick, where a square root would wait for
/// nothing. A vector with a component that is not a number is not.
inline bool longer(const Eigen::Vector3d& vector, double limit) noexcept {
  return vector.squaredNorm() > limit * limit;
}

}  // namespace haptrial
