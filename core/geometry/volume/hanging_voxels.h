#pragma once

#include <cstddef>

#include "core/geometry/volume/voxel_grid.h"

namespace haptrial::geometry {

/// Empties voxels that hang on the rest by edges or corners in one line: their tetrahedra would
/// swing there as on a hinge, which no force and no stiffness holds. Parts that touch nothing stay.
/// Border voxels are not marked anew.
/// @returns how many voxels were emptied
/// @throws InputError if a part that hangs so is more than a twentieth of the solid.
std::size_t drop_hanging_voxels(VoxelSolid& solid);

}  // namespace haptrial::geometry
