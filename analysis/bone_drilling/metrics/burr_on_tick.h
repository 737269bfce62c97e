#pragma once

#include "analysis/bone_drilling/metrics/procedure.h"
#include "core/bone/drill/burr_on_tick.h"

namespace haptrial::analysis::drilling {

using bone::BurrOnTick;
using bone::in_frame;

/// @param tool  null: none  @returns it in W
BurrOnTick burr_of(const ToolTick& tick, const ProcedureTool* tool) noexcept;

}  // namespace haptrial::analysis::drilling
