#include "core/record/rows/moving_body_row.h"

namespace haptrial::record {
namespace {

constexpr std::size_t kMovingNameBytes = 64;

}  // namespace

template <>
const Table<MovingBodyRow>& table_of<MovingBodyRow>() {
  using R = MovingBodyRow;
  using T = Table<R>;
  static const T table(
      {"moving_bodies", "how each body that moves did so, in ticks", 37, RowsOf::kPass, {"pass"}},
      {T::column("pass", &R::pass, "1", "row of /trials"),
       T::column("device", &R::device, "1", "whose tool, from 0"),
       T::text("object", &R::object, kMovingNameBytes, "of [objects]"),
       T::column("steps", &R::steps, "1", "of the body on a tick"),
       T::column("limited", &R::limited, "1",
                 "ticks on which the force was cut, as it might have given out more energy than "
                 "the hand had given"),
       T::column("flown_apart", &R::flown_apart, "1",
                 "ticks on which the body flew apart, as it was deformed beyond what its steps "
                 "are stable for, and was put to rest")});
  return table;
}

}  // namespace haptrial::record
