#include "core/bone/record/led_row.h"

#include <array>

#include "core/bone/record/turn_columns.h"

namespace haptrial::record {

template <>
const Table<LedRow>& table_of<LedRow>() {
  using R = LedRow;
  using T = Table<R>;
  using Names3 = std::array<const char*, 3>;
  static const T table(
      {"led",
       "one row for each tick of the side that teaches which the bone has followed",
       1000,
       RowsOf::kTick,
       {"sequence"}},
      {T::column("sequence", &R::sequence, "1", "own tick on which it was followed"),
       T::column("step", &R::step, "1", "of the bone, from 1 when it was new"),
       T::column("begins", &R::begins, "1", "1: the first one of a pass there"),
       T::rounded_elements(
           Names3{"x", "y", "z"}, [](R& r) -> Eigen::Vector3d& { return r.tool.position; }, "m",
           "of the tool there, in the world frame", kPositionResolution),
       T::rounded_elements(
           Names3{"vx", "vy", "vz"}, [](R& r) -> Eigen::Vector3d& { return r.tool.velocity; },
           "m/s", "of the tool there, in the world frame", kVelocityResolution),
       turn_columns(&R::orientation, "unit quaternion from the handle's frame there to the world"),
       T::column("buttons", &R::buttons, "1", "of the device there"),
       T::column("keys", &R::keys, "1", "of the window there"),
       T::rounded("pedal", &R::pedal, "1", "there", kPedalResolution)});
  return table;
}

}  // namespace haptrial::record
