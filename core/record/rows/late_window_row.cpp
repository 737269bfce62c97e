#include "core/record/rows/late_window_row.h"

namespace haptrial::record {
namespace {

constexpr std::size_t kLateNameBytes = 64;

}  // namespace

template <>
const Table<LateWindowRow>& table_of<LateWindowRow>() {
  using R = LateWindowRow;
  using T = Table<R>;
  static const T table(
      {"late_windows",
       "windows that bodies of their own rate did not end in time, the first 4,096 of each",
       40,
       RowsOf::kPass,
       {"pass"}},
      {T::column("pass", &R::pass, "1", "row of /trials"),
       T::column("device", &R::device, "1", "whose tool, from 0"),
       T::column("interval", &R::interval, "1", "of the trial, from 1"),
       T::text("object", &R::object, kLateNameBytes, "of [objects]"),
       T::column("tick", &R::tick, "1",
                 "on which the window was taken, counted while the object acts in the interval, "
                 "from 0"),
       T::column("ticks", &R::ticks, "1", "that it was too late")});
  return table;
}

}  // namespace haptrial::record
