#pragma once

#include "analysis/bone_drilling/metrics/burr_on_tick.h"
#include "analysis/bone_drilling/metrics/procedure.h"
#include "core/bone/drill/sight.h"

namespace haptrial::analysis::drilling {

using bone::is_visible;
using bone::StandingBone;
using bone::Visibility;
using bone::VisibilityMeter;

/// How much of a whole procedure's removals was seen, in their order.
Visibility visibility(const Procedure& procedure);

}  // namespace haptrial::analysis::drilling
