#pragma once

#include "core/control/handle_loop.h"

namespace haptrial::protocols {

struct Definition;

/// The loop of the device with the longest velocity window, so that damping that is safe for it is
/// safe with all devices of the definition.
control::HandleLoop handle_loop(const Definition& definition);

}  // namespace haptrial::protocols
