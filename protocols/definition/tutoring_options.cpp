#include "protocols/definition/tutoring_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/base/definition/schema.h"
#include "core/base/definition/table_vector.h"
#include "core/device/device.h"
#include "core/record/table/schema.h"
#include "protocols/definition/window_keys.h"

namespace haptrial::protocols {

using tutoring::Passivity;
using tutoring::TutoringGains;

static const Schema<TutoringNetwork>& network_schema() {
  using N = TutoringNetwork;
  static const auto schema =
      Schema<N>()
          .text("name", &N::name, "Name of a simulated network that is a condition")
          .required()
          .keys_of(&N::channel, tutoring::channel_schema());
  return schema;
}

static void read_networks(Table& table, TutoringOptions& o) {
  for (Table& each : table.tables("networks")) {
    TutoringNetwork network = network_schema().read(each);
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

static const Schema<TutoringGains>& gains_schema() {
  using G = TutoringGains;
  static const auto schema =
      Schema<G>()
          .number("stiffness", &G::stiffness, {0.0, 1000.0}, "N/m",
                  "Stiffness of the spring from the hand to the tutor's, with --tutor")
          .number("damping", &G::damping, {0.0, 100.0}, "N·s/m",
                  "Damping beside the spring from the hand to the tutor's")
          .number("force_share", &G::force_share, {0.0, 1.0}, "1",
                  "Share of the tutor's forces that is played to the hand");
  return schema;
}

const Schema<TutoringOptions>& tutoring_schema() {
  using O = TutoringOptions;
  static const auto schema =
      Schema<O>()
          .custom(
              "led_in",
              "Trials that a recorded run leads, with --tutor; every other: the first "
              "participant from the first on, the second from the second on; or the groups "
              "that alone are led, in every trial",
              [](Table& table, const std::string& key, O& o) { o.led = read_given_in(table, key); })
          .otherwise("all")
          .keys_of(&O::gains, gains_schema())
          .number("ramp", &O::ramp, {0.05, 10.0}, "s",
                  "Time over which the tutor takes the lead, and gives it back")
          .number("speed", &O::speed, {0.5, 1.0}, "1",
                  "Speed at which a recorded run is played, as a share of its own")
          .bits("pause_buttons", &O::pause_buttons,
                "Buttons of the handle; a recorded run waits while one of them is pressed")
          .otherwise("in force training every button, else none")
          .custom("pause_keys",
                  "Keys of the window; a recorded run waits while one of them is pressed",
                  [](Table& table, const std::string& key, O& o) {
                    o.pause_keys = read_window_keys(table, key);
                  })
          .otherwise("none")
          .number("authority", &O::authority, {0.0, 1.0}, "1",
                  "Share with which the hand that teaches leads the other one over a link")
          .number("felt_back", &O::felt_back, {0.0, 1.0}, "1",
                  "Share of the coupling that the hand that leads feels over a link")
          // Recordings of version 0.2 may have "waves"; only reading them needs no law of theirs.
          .choice(
              "passivity", &O::passivity,
              {{"tank", Passivity::kTank}, {"none", Passivity::kNone}, {"waves", Passivity::kTank}},
              "Law that keeps hands that are coupled over a link from swinging up; waves is "
              "read in recordings of version 0.2 alone")
          .flag("deadband", &O::deadband,
                "Whether a link sends only what would be missed, to save bandwidth")
          .flag("jitter_buffer", &O::jitter_buffer,
                "Whether the other hand's ticks are taken as evenly as they were sent, at the cost "
                "of some delay")
          .number("deadline", &O::deadline, {0.01, 5.0}, "s",
                  "Silence of a link after which its force falls to zero within 50 ms")
          .number("patience", &O::patience, {1.0, 600.0}, "s",
                  "Silence of a link after which the session ends, to be resumed")
          .table("channel", &O::channel, tutoring::channel_schema(),
                 "Simulated network of a dry run, each way")
          .custom("networks",
                  "Simulated networks that are conditions: in a dry run each trial goes over one "
                  "of them",
                  [](Table& table, const std::string&, O& o) { read_networks(table, o); });
  return schema;
}

bool asks_to_wait(const TutoringOptions& o, const device::DeviceReading& reading) noexcept {
  return (reading.buttons & o.pause_buttons) != 0 || (reading.keys & kPauseBit) != 0;
}

tutoring::SideParameters side_parameters(const TutoringOptions& o) {
  tutoring::SideParameters p;
  p.gains = o.gains;
  p.passivity = o.passivity;
  p.sparse = o.deadband;
  p.even = o.jitter_buffer;
  p.deadline = o.deadline;
  p.ramp = o.ramp;
  return p;
}

}  // namespace haptrial::protocols
