#include "analysis/bone_drilling/metrics/visibility.h"

#include "analysis/bone_drilling/metrics/in_order.h"

namespace haptrial::analysis::drilling {

BurrOnTick burr_of(const ToolTick& tick, const ProcedureTool* tool) noexcept {
  BurrOnTick burr;
  burr.centre = tick.position;
  burr.axis = tick.axis.cast<double>();
  if (tool != nullptr) {
    burr.radius = tool->burr_radius;
    burr.shape = tool->shape.get();
  }
  return burr;
}

Visibility visibility(const Procedure& procedure) {
  struct Visitor {
    const Procedure& procedure;
    VisibilityMeter meter;
    ToolTick last{};
    bool any{false};
    void view(const View& view) { meter.look_from(view.eye); }
    void crumb(const Debris& crumb) { meter.crumble(crumb.voxel); }
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
