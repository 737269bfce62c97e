#pragma once

#include "core/channel/channel_kind.h"

namespace haptrial::channel {

/// Kind `line`: an instrument that prints a line of numbers for each sample, over a serial line or
/// a named pipe. Boards with a program of one's own, load cells and grip sensors do.
/// docs/channels.md has its keys.
ChannelKind line_channel();

}  // namespace haptrial::channel
