#pragma once

#include "core/channel/channel_kind.h"

namespace haptrial::channel {

/// Kind `lsl`: a stream of the Lab Streaming Layer. Numbers become samples and texts messages, each
/// at the time of its stamp; every offset of the sender's clock that the layer measures is kept.
/// docs/channels.md has its keys.
ChannelKind lsl_channel();

}  // namespace haptrial::channel
