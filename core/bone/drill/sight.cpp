#include "core/bone/drill/sight.h"

#include <utility>

#include "core/bone/model/voxel_walk.h"

namespace haptrial::bone {

bool is_visible(const StandingBone& bone, const Voxel& voxel, const Eigen::Vector3d& eye,
                const BurrOnTick& burr) {
  const geometry::VoxelGrid& grid = bone.grid();
  bool visible = eye.allFinite();
  walk_voxels(grid, grid.centre(voxel.x(), voxel.y(), voxel.z()), eye,
              [&](const Voxel& at, double, double) {
                if (bone.holds(at) && at != voxel && !burr.touches(grid, at)) {
                  visible = false;
                }
                return visible;
              });
  return visible;
}

std::optional<double> Visibility::share() const {
  if (visible.empty()) {
    return std::nullopt;
  }
  return static_cast<double>(count) / static_cast<double>(visible.size());
}

VisibilityMeter::VisibilityMeter(std::shared_ptr<const BoneModel> bone,
                                 const Eigen::Isometry3d& pose_WB)
    : bone_(std::move(bone)), pose_BW_(pose_WB.inverse()) {}

void VisibilityMeter::look_from(const Eigen::Vector3d& eye) { eye_ = pose_BW_ * eye; }

bool VisibilityMeter::remove(const Voxel& voxel, const BurrOnTick& burr) {
  bone_.take(voxel);
  const bool seen =
      bone_.inside(voxel) && eye_ && is_visible(bone_, voxel, *eye_, in_frame(pose_BW_, burr));
  found_.visible.push_back(seen ? 1 : 0);
  found_.count += seen ? 1 : 0;
  return seen;
}

}  // namespace haptrial::bone
