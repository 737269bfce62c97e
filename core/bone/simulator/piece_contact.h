#pragma once

#include "core/base/tool_state.h"
#include "core/bone/drill/drill.h"
#include "core/bone/pieces/world.h"

namespace haptrial::bone {

/// Where a ball is immersed in any piece of bone, summed, in W: for feeling only. Servo thread: no
/// allocation, lock or throw.
Contact touch_pieces(Drill& drill, const BoneWorld& world, const ToolState& tool) noexcept;

}  // namespace haptrial::bone
