#include "core/bone/record/fragment_rows.h"

namespace haptrial::record {

template <>
const Table<PieceRow>& table_of<PieceRow>() {
  using R = PieceRow;
  using T = Table<R>;
  using Names3 = std::array<const char*, 3>;
  static const T table(
      {"pieces",
       "where pieces of bone lie: when they came off, ten times a second while a hand carries "
       "them, "
       "and when it lets go",
       64,
       RowsOf::kTick,
       {"sequence"}},
      {T::column("sequence", &R::sequence, "1", "tick from which on it lies so"),
       T::column("piece", &R::piece, "1", "from 0, the bone itself"),
       T::column("voxels", &R::voxels, "1", "when it came off; 0 in rows of its motion"),
       T::elements(Names3{"shift_x", "shift_y", "shift_z"}, &R::shift, "m",
                   "of its motion since the procedure began, p to R p + shift, in the world frame"),
       T::elements(Names3{"turn_x", "turn_y", "turn_z"}, &R::turn, "rad",
                   "rotation vector of R, in the world frame")});
  return table;
}

template <>
const Table<ScrewRow>& table_of<ScrewRow>() {
  using R = ScrewRow;
  using T = Table<R>;
  static const T table(
      {"screws",
       "screws whose driving ended; of several rows of one hole the last one counts",
       32,
       RowsOf::kTick,
       {"sequence"}},
      {T::column("sequence", &R::sequence, "1", "tick on which the driving ended"),
       T::column("tool", &R::tool, "1", "that drove it, as in /tool"),
       T::column("plate", &R::plate, "1", "from 0, in the order in which plates were fixed"),
       T::column("hole", &R::hole, "1", "of the plate, from 0"),
       T::column("piece", &R::piece, "1", "that the thread met last; -1: none"),
       T::column("depth", &R::depth, "m", "of the tip below the plate"),
       T::column("purchase", &R::purchase, "m", "length of solid bone that the thread is in"),
       T::column("torque", &R::torque, "N m", "of the last turn; simulated, not felt")});
  return table;
}

}  // namespace haptrial::record
