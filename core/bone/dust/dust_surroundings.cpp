#include "core/bone/dust/dust_surroundings.h"

#include <algorithm>

#include "core/bone/model/voxel_walk.h"

namespace haptrial::bone {

const DustBones::Change& DustBones::follow(std::span<const DustBone> bones) {
  change_.everything = false;
  change_.centres.clear();
  change_.spacing = 0.0;
  for (Replica& replica : replicas_) {
    replica.listed = false;
  }
  for (const DustBone& bone : bones) {
    follow(bone);
  }
  const auto gone = [](const Replica& replica) { return !replica.listed; };
  change_.everything = std::erase_if(replicas_, gone) > 0 || change_.everything;
  return change_;
}

void DustBones::follow(const DustBone& bone) {
  auto found = std::find_if(replicas_.begin(), replicas_.end(),
                            [&](const Replica& replica) { return replica.volume == bone.volume; });
  if (found == replicas_.end()) {
    replicas_.push_back({bone.volume, bone.X_WB, bone.X_WB.inverse(), {}, true});
    found = std::prev(replicas_.end());
    change_.everything = true;
  } else if (found->X_WB.matrix() != bone.X_WB.matrix()) {
    found->X_WB = bone.X_WB;
    found->X_BW = bone.X_WB.inverse();
    change_.everything = true;
  }
  found->listed = true;
  if (change_.everything) {
    found->occupancy.follow(*bone.volume);  // a list of a whole bone would be larger than the bone
    return;
  }
  voxels_.clear();
  found->occupancy.follow(*bone.volume, voxels_);
  const geometry::VoxelGrid& grid = bone.volume->grid();
  for (const Voxel& voxel : voxels_) {
    change_.centres.push_back(bone.X_WB * grid.centre(voxel));
    change_.spacing = std::max(change_.spacing, grid.spacing);
  }
}

bool DustBones::cross(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const {
  bool crossed = false;
  for (const Replica& replica : replicas_) {
    walk_voxels(replica.volume->grid(), replica.X_BW * from, replica.X_BW * to,
                [&](const Voxel& voxel, double, double) {
                  crossed = replica.occupancy.holds(replica.volume->address(voxel));
                  return !crossed;
                });
    if (crossed) {
      break;
    }
  }
  return crossed;
}

}  // namespace haptrial::bone
