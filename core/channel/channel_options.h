#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/definition/schema.h"
#include "core/channel/channel_kinds.h"

namespace haptrial::channel {

inline constexpr std::size_t kMostChannels = 8;

/// Values in place of an instrument where no person takes part: a sine of each quantity.
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
/// Problems are noted; of an unknown kind the other keys are left, since what they mean depends on
/// it.
std::vector<ChannelOptions> read_channels(Table& root);

/// Notes channels that share a line, which no session may begin with; recorded ones may have them.
void check_lines(Table& root, const std::vector<ChannelOptions>& channels);

/// Names of the values of these channels, "CHANNEL.QUANTITY", in the order in which a session has
/// them (DeviceReading::channels).
std::vector<std::string> names_of_values(const std::vector<ChannelOptions>& channels);

/// Place of a value among them. @param name  one of them, or "CHANNEL" for the first of a channel
/// @returns nothing if there is none of this name
std::optional<std::size_t> place_of(const std::vector<std::string>& values, std::string_view name);

/// Reads the name of a value under `key`, and notes one that is not there. @returns its place; 0
/// then
std::size_t read_value_name(Table& table, std::string_view key,
                            const std::vector<std::string>& values, std::string_view name);

}  // namespace haptrial::channel
