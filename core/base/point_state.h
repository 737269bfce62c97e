#pragma once

#include <Eigen/Core>

namespace haptrial {

/// Where a point is and how it moves, in the world frame W (docs/conventions.md).
struct PointState {
  Eigen::Vector3d position{Eigen::Vector3d::Zero()};  // p_W [m]
  Eigen::Vector3d velocity{Eigen::Vector3d::Zero()};  // v_W [m/s]
};

}  // namespace haptrial
