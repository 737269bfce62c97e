#pragma once

#include <cstdint>

#include "core/tutoring/deadband.h"
#include "core/tutoring/energy_tank.h"
#include "core/tutoring/tutoring_law.h"

namespace haptrial::tutoring {

/// Method that keeps a coupling over a delay from swinging up.
enum class Passivity : std::uint8_t {
  kNone,  // nothing: right where only one side feels the other
  kTank,  // tutoring::EnergyTank
};

struct SideParameters {
  tutoring::TutoringGains gains;
  Passivity passivity{Passivity::kTank};
  tutoring::TankParameters tank;
  bool sparse{false};  // only the messages that Deadband asks for
  tutoring::DeadbandParameters deadband;
  bool even{false};            // partner's ticks as evenly as they were sent; costs delay
  double late{0.01};           // share of messages that may be too late for that
  double longest_buffer{0.1};  // [s]
  double deadline{0.1};        // silence after which the link counts as lost > 0 [s]
  double ramp{0.5};            // from no force to all of it, also after a loss > 0 [s]
};

}  // namespace haptrial::tutoring
