#pragma once

#include "core/geometry/mesh/mesh.h"
#include "core/geometry/mesh/work.h"
#include "core/geometry/volume/voxel_grid.h"

namespace haptrial::geometry {

/// The part of voxelize() that floods. @param solid  all outside; its inside voxels are set.
/// @throws InputError when no triangle gives a seed.
void flood_fill(const Mesh& mesh, VoxelSolid& solid, const WorkReport& report);

}  // namespace haptrial::geometry
