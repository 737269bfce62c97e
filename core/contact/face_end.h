#pragma once

#include <Eigen/Core>

#include "core/geometry/mesh/closest_point.h"

namespace haptrial::contact {

/// The part of a move along a triangle after which the place is beside the triangle, `beyond` over
/// one of its sides; 1 if the move ends before or begins there.
/// @param normal  of the triangle, a unit vector; how high the place lies along it does not matter
/// @param beyond  [m]
double face_end(const geometry::Corners& corners, const Eigen::Vector3d& normal,
                const Eigen::Vector3d& from, const Eigen::Vector3d& move, double beyond) noexcept;

}  // namespace haptrial::contact
