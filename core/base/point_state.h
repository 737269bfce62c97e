#pragma once

#include <Eigen/Core>

namespace haptrial {

/// Position and velocity of a point in the world frame W (docs/conventions.md).
struct PointState {
  Eigen::Vector3d position{Eigen::Vector3d::Zero()};  // p_W [m]
  Eigen::Vector3d velocity{Eigen::Vector3d::Zero()};  // v_W [m/s]
};

}  // namespace haptrial
