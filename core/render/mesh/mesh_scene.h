#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "core/geometry/mesh/mesh.h"
#include "core/geometry/volume/tetrahedralize.h"
#include "core/geometry/volume/voxel_grid.h"
#include "core/render/mesh/scene.h"

namespace haptrial::render {

/// The part of a thing that a look inside leaves: the points p with normal · p <= offset.
struct Cut {
  Eigen::Vector3d normal;
  double offset;  // [m]
};
/// Halfway through a box across the axis that a view looks along the most.
Cut halfway(const Eigen::AlignedBox3d& box, const SceneView& view);

std::vector<SceneTriangle> scene_of(const geometry::Mesh& mesh, const Colour& colour);

/// The outer sides of the inside voxels whose centres are left: green where a voxel lies at the
/// surface of the whole solid, red inside, as the source's Figure 52 shows them; those that one
/// voxel over the surface adds are the green ones.
std::vector<SceneTriangle> scene_of(const geometry::VoxelSolid& solid,
                                    const std::optional<Cut>& cut = {});

/// The outer faces of the tetrahedra whose middles are left: green at the surface, else red.
std::vector<SceneTriangle> scene_of(const geometry::TetMesh& mesh,
                                    const std::optional<Cut>& cut = {});

}  // namespace haptrial::render
