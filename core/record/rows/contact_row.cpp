#include "core/record/rows/contact_row.h"

namespace haptrial::record {

template <>
const Table<ContactRow>& table_of<ContactRow>() {
  using R = ContactRow;
  using T = Table<R>;
  static const T table(
      {"contacts",
       "one tick of a tool on an object whose contact is recorded",
       3072,
       RowsOf::kTick,
       {"sequence"}},
      {T::column("sequence", &R::sequence, "1", "number of the tick, as in /samples"),
       T::column("device", &R::device, "1", "whose tool, from 0"),
       T::column("object", &R::object, "1", "of [objects] in the order of their names, from 0"),
       T::column("sliding", &R::sliding, "1", "1 where it slides, 0 where friction holds it"),
       T::rounded("depth", &R::depth, "m", "of the tool behind the surface"),
       T::rounded_elements<3>({"proxy_x", "proxy_y", "proxy_z"}, &R::proxy, "m",
                              "where the surface holds the tool's proxy, in W"),
       T::rounded_elements<3>({"force_x", "force_y", "force_z"}, &R::force, "N",
                              "of the object on the tool, in W"),
       T::column("work", &R::work, "J",
                 "done on the hand by the object since its stage began: above 0 it gave energy")});
  return table;
}

}  // namespace haptrial::record
