#include "core/record/rows/touched_body_row.h"

namespace haptrial::record {
namespace {

constexpr std::size_t kBodyNameBytes = 64;

}  // namespace

template <>
const Table<TouchedBodyRow>& table_of<TouchedBodyRow>() {
  using R = TouchedBodyRow;
  using T = Table<R>;
  static const T table(
      {"touched_bodies",
       "how the contact with each body that gives way went, in ticks",
       40,
       RowsOf::kPass,
       {"pass"}},
      {T::column("pass", &R::pass, "1", "row of /trials"),
       T::column("device", &R::device, "1", "whose tool, from 0"),
       T::text("object", &R::object, kBodyNameBytes, "of [objects]"),
       T::column("contact", &R::contact, "1", "ticks in contact"),
       T::column("inverted", &R::inverted, "1",
                 "ticks on which a tetrahedron would have been turned inside out: the force stayed "
                 "at what it was before"),
       T::column("unsettled", &R::unsettled, "1",
                 "ticks on which the places of contact were not found to rounding"),
       T::column("crowded", &R::crowded, "1",
                 "ticks with more places of contact than fit: the deepest were taken")});
  return table;
}

}  // namespace haptrial::record
