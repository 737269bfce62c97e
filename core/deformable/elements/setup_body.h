#pragma once

#include <functional>
#include <vector>

#include "core/deformable/elements/deform_setup.h"

namespace haptrial::deformable {

/// Called before memory is taken: what for, and how much [bytes]; throws if that is too much.
using MemoryCheck = std::function<void(const std::string& what, double bytes)>;

/// The tetrahedra that a setup states: a surface filled with voxels, a file, or a block. Vertices
/// that no tetrahedron has are left out.
/// @throws InputError as the readers of files, voxelize() and `check`
geometry::TetMesh body_of(const DeformSetup& setup, const MemoryCheck& check = {});

/// Attributes and markers of TetGen's files: the numbers that stand behind a vertex's place and
/// behind a tetrahedron's corners.
struct TetgenColumns {
  std::vector<std::vector<double>> nodes;       // (vertices)
  std::vector<std::vector<double>> tetrahedra;  // (tetrahedra)
};

/// TetGen's NAME.node and NAME.ele: numbers from 0 or 1, tetrahedra of four corners, turned where
/// they are inverted as files of other programs number them. @param scale  metres to the unit
/// @param columns  if not null, is set to what the files have beside the mesh
/// @throws InputError naming file, line and what was found.
geometry::TetMesh read_tetgen(const std::filesystem::path& node_file, double scale,
                              TetgenColumns* columns = nullptr);

/// A block of cells, five tetrahedra each, its lowest corner at the origin. Cells are cubes where
/// the sides allow it; else they are longer or shorter along a side, which is as long as stated.
/// @param resolution  cells along the longest side
geometry::TetMesh block_body(const Eigen::Vector3d& size, int resolution);

}  // namespace haptrial::deformable
