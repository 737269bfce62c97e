#include "protocols/definition/tutoring_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/base/definition/table.h"
#include "core/base/definition/table_vector.h"
#include "core/device/device.h"
#include "core/record/table/schema.h"
#include "protocols/definition/window_keys.h"

namespace haptrial::protocols {

using network::Passivity;

static void read_networks(Table& table, TutoringOptions& o) {
  if (!table.has("networks")) {
    return;
  }
  for (Table& each : table.tables("networks")) {
    TutoringNetwork network{each.text("name"), network::read_channel_conditions(each)};
    const bool taken = std::ranges::any_of(
        o.networks, [&](const TutoringNetwork& other) { return other.name == network.name; });
    if (network.name.empty() || network.name.size() >= record::kConditionBytes || taken) {
      each.reject(
          "name", "'" + network.name + "'",
          fmt::format("a name of its own of at most {} bytes", record::kConditionBytes - 1));
    }
    o.networks.push_back(std::move(network));
  }
  if (table.has("channel")) {
    table.reject("channel", "and networks are both given; leave out one of them");
  }
}

static void read_link_options(Table& table, TutoringOptions& o) {
  o.authority = table.number_or("authority", o.authority, {0.0, 1.0}, "1");
  o.felt_back = table.number_or("felt_back", o.felt_back, {0.0, 1.0}, "1");
  if (table.has("passivity")) {
    // Recordings of version 0.2 may have "waves"; whoever only reads them needs no law of theirs.
    const std::string word = table.choice("passivity", {"tank", "none", "waves"});
    o.passivity = word == "none" ? Passivity::kNone : Passivity::kTank;
  }
  if (table.has("deadband")) {
    o.deadband = table.boolean("deadband");
  }
  if (table.has("jitter_buffer")) {
    o.jitter_buffer = table.boolean("jitter_buffer");
  }
  o.deadline = table.number_or("deadline", o.deadline, {0.01, 5.0}, "s");
  o.patience = table.number_or("patience", o.patience, {1.0, 600.0}, "s");
  if (table.has("channel")) {
    Table channel = table.table("channel");
    o.channel = network::read_channel_conditions(channel);
  }
  read_networks(table, o);
}

TutoringOptions read_tutoring_options(Table& table) {
  TutoringOptions o;
  o.gains.stiffness = table.number_or("stiffness", o.gains.stiffness, {0.0, 1000.0}, "N/m");
  o.gains.damping = table.number_or("damping", o.gains.damping, {0.0, 100.0}, "N·s/m");
  o.gains.force_share = table.number_or("force_share", o.gains.force_share, {0.0, 1.0}, "1");
  o.ramp = table.number_or("ramp", o.ramp, {0.05, 10.0}, "s");
  o.speed = table.number_or("speed", o.speed, {0.5, 1.0}, "1");
  if (table.has("pause_buttons")) {
    o.pause_buttons = read_bits(table, "pause_buttons");
  }
  if (table.has("pause_keys")) {
    o.pause_keys = read_window_keys(table, "pause_keys");
  }
  read_link_options(table, o);
  return o;
}

bool asks_to_wait(const TutoringOptions& o, const device::DeviceReading& reading) noexcept {
  return (reading.buttons & o.pause_buttons) != 0 || (reading.keys & kPauseBit) != 0;
}

network::SideParameters side_parameters(const TutoringOptions& o) {
  network::SideParameters p;
  p.gains = o.gains;
  p.passivity = o.passivity;
  p.sparse = o.deadband;
  p.even = o.jitter_buffer;
  p.deadline = o.deadline;
  p.ramp = o.ramp;
  return p;
}

}  // namespace haptrial::protocols
