#pragma once

#include "core/channel/channel_kind.h"

namespace haptrial::channel {

/// The kind `robotiq`: force-torque sensors FT 150 and FT 300, which send 100 frames a second over
/// a serial line. Force [N] and torque [N·m] are in the sensor's own frame.
const ChannelKind& robotiq_channel();

}  // namespace haptrial::channel
