#include "core/bone/record/tear_row.h"

#include <array>

namespace haptrial::record {

template <>
const Table<TearRow>& table_of<TearRow>() {
  using R = TearRow;
  using T = Table<R>;
  static const T table(
      {"tears", "one row for each tear of soft tissue: an injury", 48, RowsOf::kTick, {"sequence"}},
      {T::column("sequence", &R::sequence, "1", "tick on which it tore"),
       T::column("label", &R::label, "1", "of /structures"),
       T::column("tool", &R::tool, "1",
                 "in hand, from 0 in the definition's order; -1: the tube in the other hand"),
       T::column("by_suction", &R::by_suction, "1", "1: pulled by suction, 0: pressed by the tool"),
       T::column("force", &R::force, "N", "at which it tore"),
       T::column("depth", &R::depth, "m", "how far its surface had given way"),
       T::elements(std::array<const char*, 3>{"x", "y", "z"}, &R::place, "m",
                   std::array<const char*, 3>{"on its surface at rest, in the bone frame",
                                              "likewise", "likewise"})});
  return table;
}

}  // namespace haptrial::record
