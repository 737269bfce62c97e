#pragma once

#include <Eigen/Geometry>

#include "core/bone/model/bone_model.h"

namespace haptrial::bone {

/// The voxels of a grid whose centres lie in a box, borders included; a grid without any voxel
/// where none does.
geometry::VoxelGrid grid_within(const geometry::VoxelGrid& grid, const Eigen::AlignedBox3d& box);

/// Leaves only what holds bone, with two empty voxels around it, where the grid has them.
void crop_to_bone(BoneModel& model);

}  // namespace haptrial::bone
