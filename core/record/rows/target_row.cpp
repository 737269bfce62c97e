#include "core/record/rows/target_row.h"

namespace haptrial::record {

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
