#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "core/geometry/bvh/bvh.h"
#include "core/geometry/mesh/mesh.h"

namespace haptrial::geometry {

/// Normals that tell inside from outside at the nearest point of a closed mesh, also where that
/// lies on an edge or a corner: of a face its own; of an edge the sum of its faces'; of a corner
/// the sum weighted by the angles there. Source: Baerentzen and Aanaes 2005.
class Pseudonormals {
 public:
  /// @param mesh  welded: what meets must share its vertices (mesh_repair.h). Triangles without
  /// area
  ///     count for nothing.
  /// @throws InputError when a triangle names a vertex that does not exist.
  explicit Pseudonormals(const Mesh& mesh);

  /// Pseudonormal at a nearest point, not of unit length; zero if only triangles without area meet.
  const Eigen::Vector3d& at(const ClosestPoint& nearest) const;

  /// The distance to the mesh, negative inside: `nearest` is the answer of a Bvh of the same mesh
  /// for `point`. On the surface, and where there is no answer, it has no sign: 0, infinity.
  double signed_distance(const Eigen::Vector3d& point, const ClosestPoint& nearest) const;

 private:
  std::vector<std::array<std::int32_t, 3>> corners_;
  std::vector<Eigen::Vector3d> of_face_;                 // (triangles)
  std::vector<std::array<Eigen::Vector3d, 3>> of_edge_;  // (triangles x 3)
  std::vector<Eigen::Vector3d> of_corner_;               // (vertices)
};

}  // namespace haptrial::geometry
