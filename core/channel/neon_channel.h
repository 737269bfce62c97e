#pragma once

#include "core/channel/channel_kind.h"

namespace haptrial::channel {

/// Kind `neon`: state of a Pupil Labs Neon eye tracker, asked over HTTP, and its own recording,
/// which begins and ends with the channel. Gaze comes as a stream of kind `lsl`. docs/channels.md
/// has its keys.
ChannelKind neon_channel();

}  // namespace haptrial::channel
