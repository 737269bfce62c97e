#include "protocols/definition/tutoring_options.h"

#include "core/base/definition/table.h"

namespace haptrial::protocols {

TutoringOptions read_tutoring_options(Table& table) {
  TutoringOptions o;
  o.gains.stiffness = table.number_or("stiffness", o.gains.stiffness, {0.0, 1000.0}, "N/m");
  o.gains.damping = table.number_or("damping", o.gains.damping, {0.0, 100.0}, "N·s/m");
  o.gains.force_share = table.number_or("force_share", o.gains.force_share, {0.0, 1.0}, "1");
  o.ramp = table.number_or("ramp", o.ramp, {0.05, 10.0}, "s");
  o.speed = table.number_or("speed", o.speed, {0.5, 1.0}, "1");
  return o;
}

}  // namespace haptrial::protocols
