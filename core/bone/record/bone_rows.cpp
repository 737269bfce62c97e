#include "core/bone/record/bone_rows.h"

#include <array>

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
