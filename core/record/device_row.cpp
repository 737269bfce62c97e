#include "core/record/device_row.h"

namespace haptrial::record {

template <>
const Table<DeviceRow>& table_of<DeviceRow>() {
  using T = Table<DeviceRow>;
  static const T table(
      {"devices", "one tick of a device after the first", 4096, RowsOf::kTick, {"sequence"}},
      {T::column("sequence", &DeviceRow::sequence, "1", "number of the tick, as in /samples"),
       T::column("device", &DeviceRow::device, "1", "which device, from 1; 0 is in /samples"),
       T::rounded_elements<3>({"px", "py", "pz"}, &DeviceRow::position, "m", "position in W"),
       T::rounded_elements<3>({"vx", "vy", "vz"}, &DeviceRow::velocity, "m/s", "velocity in W"),
       T::rounded_elements<3>({"fx", "fy", "fz"}, &DeviceRow::force, "N",
                              "force that was commanded, in W"),
       T::column("buttons", &DeviceRow::buttons, "1", "bit i: button i is pressed")});
  return table;
}

}  // namespace haptrial::record
