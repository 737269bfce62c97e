#pragma once

#include <Eigen/Core>

#include "core/geometry/mesh/closest_point.h"

namespace haptrial::geometry {

/// The nearest point of one triangle, in double precision: the least of the distances to its three
/// edges and, where the foot of the perpendicular lies within, to its plane. Every candidate is a
/// point of the triangle to rounding, so slivers and triangles without area cost accuracy nowhere.
/// `triangle` of the answer is -1.
/// Equal distances: an edge before the face, and edges in order.
ClosestPoint closest_on_triangle(const Eigen::Vector3d& point, const Eigen::Vector3d& corner0,
                                 const Eigen::Vector3d& corner1, const Eigen::Vector3d& corner2);

}  // namespace haptrial::geometry
