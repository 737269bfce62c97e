#include "core/bone/dust/dust_parameters.h"

#include "core/base/definition/table.h"

namespace haptrial::bone {

DustParameters read_dust_parameters(Table& table) {
  DustParameters p;
  p.cell = table.number("cell", {1e-4, 5e-3}, "m");
  p.bulking = table.number("bulking", {1.0, 100.0}, "");
  p.fall_speed = table.number("fall_speed", {0.0, 10.0, true}, "m/s");
  p.slope = table.number("slope", {0.05, 0.7}, "");
  p.suction_rate = table.number("suction_rate", {0.0, 1e-3, true}, "m3/s");
  p.suction_reach = table.number("suction_reach", {0.0, 0.02, true}, "m");
  return p;
}

}  // namespace haptrial::bone
