#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/geometry/bvh/bvh.h"
#include "core/geometry/mesh/work.h"
#include "core/geometry/volume/voxel_grid.h"

namespace haptrial::geometry {

/// Distance to a mesh for every voxel centre of a grid, and the nearest point on the mesh. Source:
/// Morris 2006, §6.3.1.
struct DistanceMap {
  VoxelGrid grid;
  std::vector<double> distance;        // (voxels) [m], negative inside; NaN where not asked for
  std::vector<Eigen::Vector3d> point;  // (voxels) the nearest point [m]; NaN likewise; or empty
  std::vector<std::int32_t> triangle;  // (voxels) that it lies on; -1 likewise; or empty
};

struct DistanceMapOptions {
  bool everywhere{false};  // else inside voxels only, as the source does
  bool points{true};       // keep the nearest points and their triangles
  int threads{0};          // 0: one per processor. The map is the same for any number
};

/// The exact distance map of a mesh: what Bvh::closest() says of each centre, signed by the voxels'
/// labels. Voxels are done brick by brick; neighbours share their search, and what was found for
/// some bounds it for the next (docs/algorithms/distance-maps.md).
/// Source: Morris 2006, §6.3.3.
/// @param solid  labels of the same mesh, from voxelize()
/// @throws std::invalid_argument when solid has not one label per voxel; Cancelled.
DistanceMap make_distance_map(const Bvh& bvh, const VoxelSolid& solid,
                              const DistanceMapOptions& options = {},
                              const WorkReport& report = {});

/// Memory that the map takes [bytes].
double distance_map_memory(const VoxelGrid& grid, const DistanceMapOptions& options);

}  // namespace haptrial::geometry
