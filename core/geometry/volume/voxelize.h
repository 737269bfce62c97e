#pragma once

#include "core/geometry/bvh/bvh.h"
#include "core/geometry/mesh/mesh.h"
#include "core/geometry/mesh/work.h"
#include "core/geometry/volume/voxel_grid.h"

namespace haptrial::geometry {

/// Rule by which the centre of a voxel is an inside one.
enum class InsideRule {
  kParity,   // a ray from it leaves the mesh an odd number of times; for closed meshes
  kWinding,  // the generalized winding number is above one half; for any mesh. Where it is a
             // whole number everywhere: is not 0, so that faces may look inwards. An open mesh
             // whose signed_volume() is negative is filled as if all its faces were turned
  kFlood,    // reached from a seed without crossing the surface; for closed meshes
};

/// Winding, which holds where closed parts overlap; parity where every edge belongs to an even
/// number of triangles that do not agree which side is out.
InsideRule fitting_rule(const Mesh& mesh);

/// Labels every voxel of a grid by its centre, and with kBorder the outside voxels that share a
/// face with an inside one: the layer by which the source overestimates a solid.
///
/// Parity is exact (see GridCrossings). So is winding, to the rounding of solid angles: a mesh
/// closed by its BoundaryCone winds around a centre a whole number of times, counted along the grid
/// lines; what the cone alone contributes is below one half, and does not matter, but near it,
/// where the triangles are summed. A flood starts a short step inside of the first triangle whose
/// step lands on an inside voxel and fills that region only. Source: Morris 2006, §5.2.2.
/// @param hierarchy  of the mesh, where there is one: it serves meshes of which the boundary is a
///     large part (more than 20,000 loops or 200,000 edges), voxel by voxel, on all processors
/// @throws InputError where parity or flood is asked of an open mesh, or a flood finds no seed.
VoxelSolid voxelize(const Mesh& mesh, const VoxelGrid& grid, InsideRule rule,
                    const WorkReport& report = {}, const Bvh* hierarchy = nullptr);

/// A bound on what voxelize() takes beside the mesh [bytes].
double voxelizing_memory(const Mesh& mesh, const VoxelGrid& grid, InsideRule rule);

/// Border voxels become inside ones, and those next to them border ones.
void grow(VoxelSolid& solid);

std::size_t count_inside(const VoxelSolid& solid);

}  // namespace haptrial::geometry
