#pragma once

#include <vector>

#include "core/channel/channel_kind.h"

namespace haptrial::channel {

/// Every kind that read_channels() knows. Call before threads are started.
const std::vector<ChannelKind>& kinds_of_channel();

/// Adds a kind of a program's own.
/// @throws std::invalid_argument for a word that is taken
void add_kind_of_channel(const ChannelKind& kind);

}  // namespace haptrial::channel
