#pragma once

#include <Eigen/Geometry>

namespace haptrial {

/// Smallest rotation that takes the direction of `from` to that of `to`; half a turn about some
/// perpendicular axis if they are opposite. Eigen's own brings a singular value decomposition into
/// every file that calls it.
/// @param from, to  finite, longer than 0
/// @returns a unit quaternion
Eigen::Quaterniond shortest_turn(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

}  // namespace haptrial
