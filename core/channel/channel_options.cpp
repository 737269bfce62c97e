#include "core/channel/channel_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>

namespace haptrial::channel {
namespace {

const Schema<SimulatedInput>& simulated_schema() {
  using S = SimulatedInput;
  constexpr Bounds kAny{-1e9, 1e9};
  static const auto schema =
      Schema<S>()
          .number("mean", &S::mean, kAny, "", "Value about which each quantity swings in a dry run")
          .number("amplitude", &S::amplitude, {0.0, 1e9}, "",
                  "How far each quantity swings to each side in a dry run")
          .number("frequency", &S::frequency, {0.0, 1000.0, true}, "Hz",
                  "How often each quantity swings in a dry run");
  return schema;
}

/// The keys that every kind has, but `kind`.
const Schema<ChannelOptions>& channel_schema() {
  using C = ChannelOptions;
  static const auto schema =
      Schema<C>()
          .flag(
              "required", &C::required,
              "Whether a pass is ended by a fault when the channel is lost; else the session goes "
              "on without it")
          .number("limit", &C::limit, {0.0, 1e9, true}, "",
                  "Amount of any quantity above which the device is stopped, such as that of a "
                  "measured force")
          .otherwise("none")
          .flag("console", &C::console, "Whether the console shows the newest values")
          .table("simulated", &C::simulated, simulated_schema(),
                 "Values in a dry run, which has no instrument");
  return schema;
}

/// The keys of [channels.NAME] that a plan of any kind has.
const Schema<ChannelPlan>& plan_schema() {
  using P = ChannelPlan;
  static const auto schema =
      Schema<P>().number("patience", &P::patience, {0.005, 60.0}, "s",
                         "Time without data after which the channel counts as lost");
  return schema;
}

const Schema<ClockOptions>& clock_schema() {
  using C = ClockOptions;
  static const auto schema =
      Schema<C>()
          .number("latency", &C::latency, {0.0, 1.0}, "s",
                  "Time from a measurement to its arrival, at least; it is taken off each sample's "
                  "time")
          .number("latency_uncertainty", &C::latency_uncertainty, {0.0, 1.0}, "s",
                  "How far `latency` may be wrong; it counts in each sample's uncertainty");
  return schema;
}

bool is_name(std::string_view text) {
  return !text.empty() && text.size() <= 40 &&
         std::all_of(text.begin(), text.end(),
                     [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; });
}

constexpr const char* kEvents = "events";  // its table would be /channel_events
constexpr const char* kNameForm = "a name of up to 40 letters, digits and '_'";

std::vector<std::string> words() {
  std::vector<std::string> words;
  for (const ChannelKind& kind : kinds_of_channel()) {
    words.push_back(kind.word);
  }
  return words;
}

/// A table has each column once.
void reject_taken_columns(Table& table, const ChannelPlan& plan) {
  std::vector<std::string> taken{"sample", "time_ns", "received_ns", "uncertainty", "device_time"};
  for (const Quantity& quantity : plan.quantities) {
    if (std::find(taken.begin(), taken.end(), quantity.name) != taken.end()) {
      table.reject("kind", fmt::format("of a channel with a quantity called '{}'", quantity.name),
                   fmt::format("names of quantities other than {}", fmt::join(taken, ", ")));
    }
    taken.push_back(quantity.name);
  }
}

ChannelOptions read_channel(Table& table, const std::string& name) {
  ChannelOptions options;
  options.name = name;
  table.describe({"kind", "Kind of instrument or protocol", "", true});
  options.kind = table.choice("kind", words());
  if (table.whole_text("kind") != options.kind) {
    for (const std::string& key : table.keys()) {
      table.leave(key);  // what it means is not known
    }
    return options;
  }
  channel_schema().read(table, options);
  const auto& kinds = kinds_of_channel();
  const auto kind = std::find_if(kinds.begin(), kinds.end(), [&](const ChannelKind& each) {
    return each.word == options.kind;
  });
  options.plan = kind->read(table);
  plan_schema().read(table, options.plan);
  clock_schema().read(table, options.plan.clock);
  reject_taken_columns(table, options.plan);
  return options;
}

}  // namespace

void check_quantities(Table& table, std::string_view key, std::vector<Quantity>& quantities) {
  for (const Quantity& each : quantities) {
    if (!is_name(each.name)) {
      table.reject(key, fmt::format("'{}'", each.name), kNameForm);
    }
  }
  if (quantities.empty() || quantities.size() > kMostQuantities) {
    table.reject(key, fmt::format("{} quantities", quantities.size()),
                 fmt::format("1 to {}, each with its unit: {{ force = \"N\" }}", kMostQuantities));
    quantities.resize(1);
  }
}

std::vector<Quantity> read_quantities(Table& table, std::string_view key) {
  std::vector<Quantity> quantities;
  Table inner = table.table(key);
  for (const std::string& name : inner.keys_as_written()) {
    inner.describe({name, "Unit of the quantity of this name; \"1\" for a pure number", "", true});
    quantities.push_back({name, inner.text(name)});
  }
  check_quantities(table, key, quantities);
  return quantities;
}

std::vector<std::string> names_of_values(const std::vector<ChannelOptions>& channels) {
  std::vector<std::string> names;
  for (const ChannelOptions& channel : channels) {
    for (const Quantity& quantity : channel.plan.quantities) {
      names.push_back(channel.name + "." + quantity.name);
    }
  }
  return names;
}

std::optional<std::size_t> place_of(const std::vector<std::string>& values, std::string_view name) {
  const std::string first = std::string(name) + ".";
  const auto found = std::find_if(values.begin(), values.end(), [&](const std::string& value) {
    return value == name || value.starts_with(first);
  });
  return found == values.end() ? std::nullopt
                               : std::optional(static_cast<std::size_t>(found - values.begin()));
}

std::size_t read_value_name(Table& table, std::string_view key,
                            const std::vector<std::string>& values, std::string_view name) {
  const auto place = place_of(values, name);
  if (!place) {
    table.reject(key, fmt::format("\"{}\"", name),
                 values.empty() ? "no channel: the definition states none"
                                : fmt::format("a value of a channel: {}", fmt::join(values, ", ")));
  }
  return place.value_or(0);
}

std::vector<ChannelOptions> read_channels(Table& root) {
  std::vector<ChannelOptions> channels;
  if (!root.has("channels")) {
    return channels;
  }
  Table all = root.table("channels");
  for (const std::string& name : all.keys_as_written()) {
    if (!is_name(name) || name == kEvents) {
      all.reject(name, fmt::format("'{}'", name),
                 fmt::format("{}, other than '{}'", kNameForm, kEvents));
    }
    Table table = all.table(name);
    channels.push_back(read_channel(table, name));
  }
  if (channels.size() > kMostChannels) {
    root.reject("channels", fmt::format("{} channels", channels.size()),
                fmt::format("at most {}", kMostChannels));
  }
  return channels;
}

void check_lines(Table& root, const std::vector<ChannelOptions>& channels) {
  for (auto channel = channels.begin(); channel != channels.end(); ++channel) {
    const std::string& path = channel->plan.path;
    const auto same = std::find_if(channels.begin(), channel, [&](const ChannelOptions& other) {
      return other.plan.path == path;
    });
    if (!path.empty() && same != channel) {
      root.table("channels")
          .table(channel->name)
          .reject("path", fmt::format("\"{}\", as that of channel {}", path, same->name),
                  "a line of its own: each of two readers gets half of what comes");
    }
  }
}

}  // namespace haptrial::channel
