#pragma once

#include <Eigen/LU>
#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/deformable/body/load_case.h"
#include "core/deformable/body/mesh_parts.h"

namespace haptrial::test {

/// The forces of a first Piola stress that is the same on the whole surface: each outer face's
/// share of P N A on its three corners.
inline std::vector<deformable::NodalForce> surface_forces(const geometry::TetMesh& mesh,
                                                          const Eigen::Matrix3d& piola) {
  std::vector<deformable::NodalForce> forces;
  for (const deformable::Face& face : deformable::mesh_parts(mesh.tetrahedra).surface) {
    const auto at = [&](std::size_t i) -> const Eigen::Vector3d& {
      return mesh.vertices[static_cast<std::size_t>(face[i])];
    };
    const Eigen::Vector3d area = 0.5 * (at(1) - at(0)).cross(at(2) - at(0));
    for (const std::int32_t vertex : face) {
      forces.push_back({vertex, piola * area / 3});
    }
  }
  return forces;
}

/// A body under an even stress, the vertices `held` where the deformation gradient f takes them.
inline deformable::LoadCase even_load(const geometry::TetMesh& mesh, const Eigen::Matrix3d& f,
                                      const Eigen::Matrix3d& piola,
                                      const std::vector<std::int32_t>& held) {
  deformable::LoadCase load{"even", {}, surface_forces(mesh, piola)};
  for (const std::int32_t v : held) {
    const Eigen::Vector3d& x = mesh.vertices[static_cast<std::size_t>(v)];
    load.holds.push_back({v, (f - Eigen::Matrix3d::Identity()) * x});
  }
  return load;
}

/// The largest distance between `u` and the displacement of f [m].
inline double farthest_from_even(const geometry::TetMesh& mesh,
                                 const std::vector<Eigen::Vector3d>& u, const Eigen::Matrix3d& f) {
  double farthest = 0;
  for (std::size_t v = 0; v < u.size(); ++v) {
    const Eigen::Vector3d expected = (f - Eigen::Matrix3d::Identity()) * mesh.vertices[v];
    farthest = std::max(farthest, (u[v] - expected).norm());
  }
  return farthest;
}

}  // namespace haptrial::test
