#include "core/record/rows/tutoring_row.h"

namespace haptrial::record {

template <>
const Table<TutoringRow>& table_of<TutoringRow>() {
  using R = TutoringRow;
  using T = Table<R>;
  static const T table(
      {"tutoring",
       "one tick during which a tutor leads the tool",
       3584,
       RowsOf::kTick,
       {"sequence"}},
      {T::column("sequence", &R::sequence, "1", "number of the tick, as in /samples"),
       T::column("time", &R::time, "s", "in what the tutor did, from the beginning of the run"),
       T::column("lead", &R::lead, "1", "the tutor's authority, 0 to 1"),
       T::rounded_elements<3>({"position_x", "position_y", "position_z"}, &R::position, "m",
                              "of the tutor's tool, in W"),
       T::rounded_elements<3>({"tutor_force_x", "tutor_force_y", "tutor_force_z"}, &R::tutor_force,
                              "N", "that was on the tutor's tool, in W"),
       T::rounded_elements<3>({"played_force_x", "played_force_y", "played_force_z"},
                              &R::played_force, "N",
                              "of the tutor on the tool, before the envelope, in W")});
  return table;
}

}  // namespace haptrial::record
