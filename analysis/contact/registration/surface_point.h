#pragma once

#include <Eigen/Core>

#include "core/geometry/bvh/bvh.h"
#include "core/geometry/mesh/mesh.h"

namespace haptrial::evaluation {

/// The nearest point of a surface with its signed distance and direction.
struct SurfacePoint {
  Eigen::Vector3d point;   // on the mesh [m]
  Eigen::Vector3d normal;  // gradient of the distance, out of the body, unit length
  double distance{0.0};    // negative inside [m]
};

/// The side is that of the nearest triangle's plane, or, near an edge or a corner, that of the line
/// from the nearest point if it leaves the triangle by its outside.
SurfacePoint nearest_surface(const geometry::Bvh& bvh, const geometry::Mesh& mesh,
                             const Eigen::Vector3d& p);

}  // namespace haptrial::evaluation
