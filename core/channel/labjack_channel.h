#pragma once

#include "core/channel/channel_kind.h"

namespace haptrial::channel {

/// The kind `labjack`: analogue inputs of LabJack T4, T7 and T8, which are asked over Modbus TCP.
const ChannelKind& labjack_channel();

}  // namespace haptrial::channel
