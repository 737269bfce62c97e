#include "core/bone/record/tuning_row.h"

namespace haptrial::record {

template <>
const Table<TuningRow>& table_of<TuningRow>() {
  using R = TuningRow;
  using T = Table<R>;
  static const T table(
      {"tuning", "one row for each key that was tuned in a pilot", 16, RowsOf::kTick, {"sequence"}},
      {T::column("sequence", &R::sequence, "1", "first tick with the new value"),
       T::text("key", &R::key, 96, "of the definition, by its path"),
       T::column("before", &R::before, "1", "value before, in the unit of the key"),
       T::column("after", &R::after, "1", "new value, likewise")});
  return table;
}

}  // namespace haptrial::record
