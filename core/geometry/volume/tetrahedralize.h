#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "core/base/big_array.h"
#include "core/geometry/volume/voxel_grid.h"

namespace haptrial::geometry {

/// Corners a, b, c, d with (b - a) · ((c - a) x (d - a)) > 0.
using Tetrahedron = std::array<std::int32_t, 4>;

/// A tetrahedral mesh with shared vertices.
struct TetMesh {
  BigArray<Eigen::Vector3d> vertices;  // [m]
  BigArray<std::uint8_t> on_surface;   // by vertex: 1 where a tetrahedron's outer face has it
  BigArray<Tetrahedron> tetrahedra;
};

/// Splits every inside voxel into five tetrahedra, one regular in its middle and four at corners of
/// it. Voxels take turns between the two mirror images of the split, by the parity of i + j + k, so
/// that the faces of neighbours match; voxels share their vertices. Vertices are numbered as the
/// voxels' corners lie in memory, tetrahedra as their voxels do, five after five.
/// Source: Morris 2006, §5.2.2.
/// @param mesh  is overwritten; its memory is used again, so that meshing the same solid again, as
///     after a cut, touches no new page.
/// @throws InputError when the solid has no inside voxel or more vertices than 32 bits number.
void tetrahedralize(const VoxelSolid& solid, TetMesh& mesh);
TetMesh tetrahedralize(const VoxelSolid& solid);

/// Memory that tetrahedralize() takes for so many inside voxels: at most, with every voxel apart,
/// and beside them the bits of the grid [bytes].
double tetrahedralizing_memory(const VoxelGrid& grid, std::size_t inside);

}  // namespace haptrial::geometry
