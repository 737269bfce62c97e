#include "analysis/bone_drilling/metrics/burr_on_tick.h"

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

}  // namespace haptrial::analysis::drilling
