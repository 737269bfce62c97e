#pragma once

#include "core/geometry/mesh.h"
#include "core/geometry/voxel_grid.h"
#include "core/geometry/work.h"

namespace haptrial::geometry {

/// The part of voxelize() that floods. @param solid  all outside; its inside voxels are set.
/// @throws InputError when no triangle gives a seed.
void flood_fill(const Mesh& mesh, VoxelSolid& solid, const WorkReport& report);

}  // namespace haptrial::geometry
