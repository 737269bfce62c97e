#include "core/record/rows/device_row.h"

namespace haptrial::record {

template <>
const Table<DeviceRow>& table_of<DeviceRow>() {
  using T = Table<DeviceRow>;
  static const T table(
      {"devices",
       "one tick of a device after the first",
       4096,
       RowsOf::kTick,
       {"sequence"},
       "devices",
       5},
      {T::column("sequence", &DeviceRow::sequence, "1", "number of the tick, as in /samples"),
       T::column("device", &DeviceRow::device, "1", "which device, from 1; 0 is in /samples"),
       T::rounded_elements<3>({"position_x", "position_y", "position_z"}, &DeviceRow::position, "m",
                              "position in W"),
       T::rounded_elements<3>({"velocity_x", "velocity_y", "velocity_z"}, &DeviceRow::velocity,
                              "m/s", "velocity in W"),
       T::rounded_elements<3>({"force_x", "force_y", "force_z"}, &DeviceRow::force, "N",
                              "force that was commanded, in W"),
       T::column("buttons", &DeviceRow::buttons, "1", "bit i: button i is pressed")});
  return table;
}

}  // namespace haptrial::record
