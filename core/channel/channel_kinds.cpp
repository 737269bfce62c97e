#include "core/channel/channel_kinds.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace haptrial::channel {
namespace {

std::vector<ChannelKind>& all_kinds() {
  static std::vector<ChannelKind> kinds{
      labjack_channel(), line_channel(),    lsl_channel(),  neon_channel(),
      rdt_channel(),     robotiq_channel(), vrpn_channel(),
  };
  return kinds;
}

}  // namespace

const std::vector<ChannelKind>& kinds_of_channel() { return all_kinds(); }

void add_kind_of_channel(const ChannelKind& kind) {
  if (std::ranges::find(all_kinds(), kind.word, &ChannelKind::word) != all_kinds().end()) {
    throw std::invalid_argument(
        fmt::format("add_kind_of_channel: there is a channel '{}' already", kind.word));
  }
  all_kinds().push_back(kind);
}

}  // namespace haptrial::channel
