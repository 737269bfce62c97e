#include "core/bone/record/field_row.h"

#include <array>

namespace haptrial::record {

template <>
const Table<OpeningRow>& table_of<OpeningRow>() {
  using R = OpeningRow;
  using T = Table<R>;
  static const T table(
      {"openings", "one row for each place that began to bleed", 32, RowsOf::kTick, {"sequence"}},
      {T::column("sequence", &R::sequence, "1", "tick on which it was opened"),
       T::column("label", &R::label, "1", "of /structures"),
       T::elements(std::array<const char*, 3>{"x", "y", "z"}, &R::place, "m",
                   std::array<const char*, 3>{"in the bone frame", "likewise", "likewise"})});
  return table;
}

template <>
const Table<FieldRow>& table_of<FieldRow>() {
  using R = FieldRow;
  using T = Table<R>;
  static const T table(
      {"field", "blood and heat up to the end of each pass", 16, RowsOf::kEndedPass, {"pass"}},
      {T::column("pass", &R::pass, "1", "row of /trials"),
       T::column("bled", &R::bled, "m3", "blood since the bone was new"),
       T::column("blood_sucked", &R::blood_sucked, "m3", "of it that was sucked away"),
       T::column("blood_lying", &R::blood_lying, "m3", "of it that lies in the field"),
       T::column("hottest", &R::hottest, "degree C",
                 "at the burr since the bone was new; 0: nothing warms up"),
       T::column("harmful_time", &R::harmful_time, "s",
                 "above heat.harmful since the bone was new")});
  return table;
}

}  // namespace haptrial::record
