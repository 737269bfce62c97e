#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/definition/schema.h"
#include "core/channel/channel_kinds.h"

namespace haptrial::channel {

inline constexpr std::size_t kMostChannels = 8;

/// What stands in for an instrument where no person takes part: a sine of each quantity.
struct SimulatedInput {
  double mean{0.0};       // in the unit of the quantity
  double amplitude{0.0};  // likewise, >= 0
  double frequency{0.5};  // > 0 [Hz]
};

/// A channel as a definition or lab file states it: [channels.NAME].
struct ChannelOptions {
  std::string name;
  std::string kind;             // a word of kinds_of_channel()
  bool required{false};         // its loss ends a pass
  std::optional<double> limit;  // of the amount of each quantity; beyond it the device is stopped
  bool console{true};           // the experimenter sees its newest values
  SimulatedInput simulated;
  ChannelPlan plan;
};

/// The channels of a definition, in the order of its text. @param root  of the definition
/// Problems are noted. @throws InputError for an unknown kind, alone: what the other keys mean
/// depends on it
std::vector<ChannelOptions> read_channels(Table& root);

}  // namespace haptrial::channel
