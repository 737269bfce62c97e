#include "core/record/rows/arm_row.h"

namespace haptrial::record {

template <>
const Table<ArmRow>& table_of<ArmRow>() {
  using R = ArmRow;
  using T = Table<R>;
  static const T table(
      {"arms", "what the rows of /devices are of", 4, RowsOf::kSession, {"device"}},
      {T::column("device", &R::device, "1", "as in /devices; 0 is in /samples"),
       T::text("name", &R::name, kNameBytes, "in the definition"),
       T::text("part", &R::part, kNameBytes,
               "tip; rotation: positions are r times the rotation vector, forces the torque over "
               "r; grip: x is the opening"),
       T::column("of", &R::of, "1", "number of the device whose part it is"),
       T::column("radius", &R::radius, "m", "r, of the fingers about the axis of a rotation")});
  return table;
}

}  // namespace haptrial::record
