#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>

#include "tests/support/solid_block.h"

namespace haptrial::test {

/// A block of cubes whose vertices a function takes from the unit cube to where they lie.
inline geometry::TetMesh mapped_block(
    const std::array<std::int32_t, 3>& cubes,
    const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& map) {
  geometry::TetMesh mesh = solid_block(cubes, 1);
  for (Eigen::Vector3d& vertex : mesh.vertices) {
    vertex = map(vertex.cwiseQuotient(Eigen::Vector3d(cubes[0], cubes[1], cubes[2])));
  }
  return mesh;
}

/// The vertices of a block of cubes, by their place in it: true where `at` says so of the whole
/// numbers along its sides.
inline std::vector<std::int32_t> lattice_vertices(
    const std::array<std::int32_t, 3>& cubes,
    const std::function<bool(const std::array<std::int32_t, 3>&)>& at) {
  std::vector<std::int32_t> found;
  std::int32_t vertex = 0;
  for (std::int32_t k = 0; k <= cubes[2]; ++k) {
    for (std::int32_t j = 0; j <= cubes[1]; ++j) {
      for (std::int32_t i = 0; i <= cubes[0]; ++i, ++vertex) {
        if (at({i, j, k})) {
          found.push_back(vertex);
        }
      }
    }
  }
  return found;
}

}  // namespace haptrial::test
