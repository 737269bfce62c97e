#include "core/bone/record/second_hand_row.h"

#include <array>

#include "core/bone/record/turn_columns.h"

namespace haptrial::record {

template <>
const Table<SecondHandRow>& table_of<SecondHandRow>() {
  using R = SecondHandRow;
  using T = Table<R>;
  static const T table(
      {"second_hand",
       "the tube in the other hand on each tick of the servo loop",
       4096,
       RowsOf::kEachTick,
       {"sequence"},
       // The table has a group of its own: made anew beside other tables it would have no row for
       // their ticks.
       "second_hand",
       5},
      {T::column("sequence", &R::sequence, "1", "tick number, as in /samples"),
       turn_columns(&R::orientation, "unit quaternion from the handle's frame to the world"),
       T::column("sucks", &R::sucks, "1", "1 where it sucks"),
       T::column("rinses", &R::rinses, "1", "1 where water runs"),
       T::column("immersed", &R::immersed, "1", "samples of its end in bone"),
       T::rounded_elements(std::array<const char*, 3>{"contact_x", "contact_y", "contact_z"},
                           &R::contact, "N",
                           "force of bone and soft tissue before any limit, in the world frame",
                           kForceResolution)});
  return table;
}

template <>
const Table<ToolContactRow>& table_of<ToolContactRow>() {
  using R = ToolContactRow;
  using T = Table<R>;
  static const T table(
      {"tool_contact",
       "the push of the two hands' tools on each tick of the servo loop",
       4096,
       RowsOf::kEachTick,
       {"sequence"},
       "tool_contact",
       5},
      {T::column("sequence", &R::sequence, "1", "tick number, as in /samples"),
       T::rounded_elements(std::array<const char*, 3>{"force_x", "force_y", "force_z"}, &R::force,
                           "N",
                           "force of the tube on the first hand's tool before any limit of the "
                           "device, in the world frame; its opposite acts on the tube",
                           kForceResolution)});
  return table;
}

}  // namespace haptrial::record
