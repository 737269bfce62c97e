#include "core/record/rows/taken_back_row.h"

namespace haptrial::record {

template <>
const Table<TakenBackRow>& table_of<TakenBackRow>() {
  using R = TakenBackRow;
  using T = Table<R>;
  static const T table(
      {"taken_back",
       "one row for each pass whose answers the experimenter took back: it counts as aborted",
       72,
       RowsOf::kEndedPass,
       {"time_ns", "pass"},
       "taken_back",
       5},
      {T::column("time_ns", &R::time_ns, "ns", "since the first tick of the session"),
       T::column("trial", &R::trial, "1", "trial number, as in /trials"),
       T::column("pass", &R::pass, "1", "row of /trials")});
  return table;
}

}  // namespace haptrial::record
