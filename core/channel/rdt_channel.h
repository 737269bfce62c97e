#pragma once

#include "core/channel/channel_kind.h"

namespace haptrial::channel {

/// The kind `rdt`: force-torque sensors that send RDT records over UDP (ATI Net F/T and Axia,
/// Schunk FTN-Axia, OnRobot). Force [N] and torque [N·m] are in the sensor's own frame.
const ChannelKind& rdt_channel();

}  // namespace haptrial::channel
