#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>

#include "core/base/random.h"
#include "tests/support/solid_block.h"

namespace haptrial::test {

/// A block as solid_block(), its vertices moved at random by up to `share` of the spacing.
inline geometry::TetMesh jittered_block(const std::array<std::int32_t, 3>& cubes, double spacing,
                                        double share, std::uint64_t seed = 1) {
  geometry::TetMesh mesh = solid_block(cubes, spacing);
  RandomStream random(seed, "jitter");
  for (Eigen::Vector3d& vertex : mesh.vertices) {
    for (int axis = 0; axis < 3; ++axis) {
      vertex[axis] += share * spacing * (2 * random.uniform() - 1);
    }
  }
  return mesh;
}

/// The same tetrahedra in an order that mixes those of different cubes.
inline void shuffle_tetrahedra(geometry::TetMesh& mesh, std::uint64_t seed = 1) {
  RandomStream random(seed, "order");
  for (std::size_t i = mesh.tetrahedra.size(); i > 1; --i) {
    std::swap(mesh.tetrahedra[i - 1], mesh.tetrahedra[random.below(i)]);
  }
}

}  // namespace haptrial::test
