#include "analysis/bone_drilling/metrics/visibility.h"

#include <utility>

#include "analysis/bone_drilling/procedure/in_order.h"
#include "core/bone/model/voxel_walk.h"

namespace haptrial::analysis::drilling {

bool is_visible(const StandingBone& bone, const bone::Voxel& voxel, const Eigen::Vector3d& eye,
                const BurrOnTick& burr) {
  const geometry::VoxelGrid& grid = bone.grid();
  bool visible = eye.allFinite();
  bone::walk_voxels(grid, grid.centre(voxel.x(), voxel.y(), voxel.z()), eye,
                    [&](const bone::Voxel& at, double, double) {
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

VisibilityMeter::VisibilityMeter(std::shared_ptr<const bone::BoneModel> bone,
                                 const Eigen::Isometry3d& pose_WB)
    : bone_(std::move(bone)), pose_BW_(pose_WB.inverse()) {}

void VisibilityMeter::look_from(const Eigen::Vector3d& eye) { eye_ = pose_BW_ * eye; }

bool VisibilityMeter::remove(const bone::Voxel& voxel, const BurrOnTick& burr) {
  bone_.take(voxel);
  const bool seen =
      bone_.inside(voxel) && eye_ && is_visible(bone_, voxel, *eye_, in_frame(pose_BW_, burr));
  found_.visible.push_back(seen ? 1 : 0);
  found_.count += seen ? 1 : 0;
  return seen;
}

Visibility visibility(const Procedure& procedure) {
  struct Visitor {
    const Procedure& procedure;
    VisibilityMeter meter;
    ToolTick last{};
    bool any{false};
    void view(const View& view) { meter.look_from(view.eye); }
    void crumb(const Crumb& crumb) { meter.crumble(crumb.voxel); }
    void tick(const ToolTick& tick) {
      last = tick;
      any = true;
    }
    void cut(const Removal& cut) { meter.cut(cut.voxel); }
    void removal(const Removal& removal) {
      const bool now = any && last.sequence == removal.sequence;
      meter.remove(removal.voxel, burr_of(last, now ? procedure.tool(last.tool) : nullptr));
    }
  };
  Visitor visitor{procedure, VisibilityMeter(procedure.bone, procedure.pose_WB)};
  visit_in_order(procedure, visitor);
  return visitor.meter.visibility();
}

}  // namespace haptrial::analysis::drilling
