#include "core/record/rows/cursor_row.h"

namespace haptrial::record {

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

}  // namespace haptrial::record
