#include "core/sound/actuator.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/base/definition/schema.h"

namespace haptrial::sound {
namespace {

constexpr int kMostChannels = 32;

const Schema<Actuator>& actuator_schema() {
  using A = Actuator;
  static const auto schema =
      Schema<A>()
          .integer("channel", &A::channel, 1, kMostChannels,
                   "Channel of the sound card on which the actuator is, from 1")
          .required()
          .number("full_scale", &A::full_scale, {0.0, 1e6, true}, "",
                  "Peak that a signal of full scale gives, in the actuator's unit, as it was "
                  "calibrated")
          .required()
          .text("unit", &A::unit, "Unit of the actuator's amplitudes: m/s², g, N")
          .required()
          .number("lowest", &A::lowest, {1.0, 20'000.0}, "Hz",
                  "Lowest frequency for which the calibration holds")
          .number("highest", &A::highest, {1.0, 20'000.0}, "Hz",
                  "Highest frequency for which the calibration holds")
          .check([](Table& table, A& actuator) {
            if (!(actuator.highest > actuator.lowest)) {
              table.reject("highest", "must be above lowest; change one of them");
            }
          });
  return schema;
}

}  // namespace

std::vector<Actuator> read_actuators(Table& root) {
  std::vector<Actuator> actuators;
  if (!root.has("actuators")) {
    return actuators;
  }
  Table table = root.table("actuators");
  for (const std::string& name : table.keys_as_written()) {
    Table own = table.table(name);
    Actuator actuator = actuator_schema().read(own);
    actuator.name = name;
    const auto same = std::ranges::find(actuators, actuator.channel, &Actuator::channel);
    if (same != actuators.end()) {
      own.reject("channel",
                 fmt::format("is that of {}, too; each actuator has its own", same->name));
    }
    actuators.push_back(std::move(actuator));
  }
  return actuators;
}

}  // namespace haptrial::sound
