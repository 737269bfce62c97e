#pragma once

#include "analysis/bone_drilling/metrics/procedure.h"
#include "core/bone/drill/sight.h"

namespace haptrial::analysis::drilling {

using bone::BurrOnTick;
using bone::in_frame;

/// @param tool  null: none  @returns it in W
BurrOnTick burr_of(const ToolTick& tick, const ProcedureTool* tool) noexcept;

using bone::is_visible;
using bone::StandingBone;
using bone::Visibility;
using bone::VisibilityMeter;

/// How much of a whole procedure's removals was seen, in their order.
Visibility visibility(const Procedure& procedure);

}  // namespace haptrial::analysis::drilling
