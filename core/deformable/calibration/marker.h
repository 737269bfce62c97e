#pragma once

#include <Eigen/Core>
#include <span>

#include "core/geometry/volume/tetrahedralize.h"

namespace haptrial::deformable {

/// A place of the body whose way under a load was measured.
struct Marker {
  geometry::Tetrahedron vertices;
  Eigen::Vector4d weights;  // of the vertices, in sum 1
  Eigen::Vector3d moved;    // where it is under the load [m]
};

/// A marker that is at `rest` at rest: in the tetrahedron that has it, or outside of the one that
/// comes nearest to having it.
Marker marker_at(const geometry::TetMesh& body, const Eigen::Vector3d& rest,
                 const Eigen::Vector3d& moved);

/// Place of the marker in a body with vertices at `positions` [m].
Eigen::Vector3d place_of(const Marker& marker, std::span<const Eigen::Vector3d> positions);

}  // namespace haptrial::deformable
