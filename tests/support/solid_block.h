#pragma once

#include <array>
#include <cstdint>

#include "core/geometry/volume/tetrahedralize.h"

namespace haptrial::test {

/// A block of cubes with edges of `spacing` [m] and one corner at the origin, five tetrahedra each.
inline geometry::TetMesh solid_block(const std::array<std::int32_t, 3>& cubes, double spacing) {
  geometry::VoxelSolid solid;
  solid.grid = {cubes, Eigen::Vector3d::Constant(0.5 * spacing), spacing};
  solid.labels.assign(solid.grid.count(), geometry::VoxelLabel::kInside);
  return geometry::tetrahedralize(solid);
}

}  // namespace haptrial::test
