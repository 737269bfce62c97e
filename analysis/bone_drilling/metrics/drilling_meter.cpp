#include "analysis/bone_drilling/metrics/drilling_meter.h"

#include <utility>

namespace haptrial::analysis::drilling {

DrillingMeter::DrillingMeter(std::shared_ptr<const bone::BoneModel> bone,
                             const Eigen::Isometry3d& pose_WB,
                             const std::vector<ProcedureTool>& tools, double rate,
                             StudyBones& bones, const ProcedurePlans& plans)
    : tools_(tools),
      usage_(bone, tools, rate),
      visibility_(bone, pose_WB),
      injuries_(bone, pose_WB, tools, bones),
      achieved_(plans, bone, pose_WB, rate, bones) {}

BurrOnTick DrillingMeter::burr() const noexcept {
  const bool known = last_.tool >= 0 && std::cmp_less(last_.tool, tools_.size());
  return burr_of(last_, known ? &tools_[static_cast<std::size_t>(last_.tool)] : nullptr);
}

void DrillingMeter::view(const View& view) {
  usage_.view(view);
  visibility_.look_from(view.eye);
}

void DrillingMeter::crumb(const Debris& crumb) {
  taken_.clear();
  visibility_.crumble(crumb.voxel, &taken_);
  injuries_.crumble(taken_);
  for (const bone::Voxel& voxel : taken_) {
    achieved_.remove(voxel);
  }
}

void DrillingMeter::tick(const ToolTick& tick) {
  last_ = tick;
  any_ = true;
  usage_.tick(tick);
  injuries_.tick(tick, burr(), time());
  achieved_.tick(tick);
}

void DrillingMeter::removal(const Removal& removal) {
  const bool now = any_ && last_.sequence == removal.sequence;
  visibility_.remove(removal.voxel, now ? burr() : burr_of(last_, nullptr));
  usage_.remove(removal);
  injuries_.remove(removal, time());
  achieved_.remove(removal.voxel);
}

void DrillingMeter::cut(const Removal& cut) {
  visibility_.cut(cut.voxel);
  usage_.remove(cut);
  injuries_.remove(cut, time());
  achieved_.remove(cut.voxel);
}

}  // namespace haptrial::analysis::drilling
