#include "core/record/rows/device_rows.h"

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

template <>
const Table<CursorRow>& table_of<CursorRow>() {
  using R = CursorRow;
  using T = Table<R>;
  static const T table(
      {"cursor",
       "the cursor of [cursor] on one tick of an interval",
       3072,
       RowsOf::kTick,
       {"sequence"}},
      {T::column("sequence", &R::sequence, "1", "number of the tick, as in /samples"),
       T::rounded_elements<3>({"x", "y", "z"}, &R::place, "m", "place of the cursor, in W"),
       T::column("shown", &R::shown, "1", "1 where the stage shows it")});
  return table;
}

template <>
const Table<TargetRow>& table_of<TargetRow>() {
  using R = TargetRow;
  using T = Table<R>;
  static const T table(
      {"targets",
       "a moving target on one tick on which it is shown",
       3072,
       RowsOf::kTick,
       {"sequence"}},
      {T::column("sequence", &R::sequence, "1", "number of the tick, as in /samples"),
       T::column("target", &R::target, "1", "of [targets] in the order of their names, from 0"),
       T::rounded_elements<3>({"x", "y", "z"}, &R::place, "m", "its place, in W")});
  return table;
}

}  // namespace haptrial::record
