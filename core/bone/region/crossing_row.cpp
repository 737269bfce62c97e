#include "core/bone/region/crossing_row.h"

#include <algorithm>

namespace haptrial::record {

template <>
const Table<CrossingRow>& table_of<CrossingRow>() {
  using R = CrossingRow;
  using T = Table<R>;
  static const T table(
      {"crossings",
       "one row for each way of a burr through a forbidden region, when it ended",
       53,
       RowsOf::kTick,
       {"sequence"}},
      {T::column("sequence", &R::sequence, "1", "last tick in the region"),
       T::column("begin", &R::begin, "1", "first tick in it"),
       T::column("label", &R::label, "1", "of the structure, in /structures"),
       T::column("given", &R::given, "1",
                 "1 where the participant felt or heard the region; else only recorded"),
       T::column("depth", &R::depth, "m", "greatest, of the burr's surface in the margin")});
  return table;
}

}  // namespace haptrial::record

namespace haptrial::bone {

CrossingWatch::CrossingWatch(std::vector<std::uint8_t> labels) : crossings_(labels.size()) {
  for (std::size_t n = 0; n < labels.size(); ++n) {
    crossings_[n].row.label = labels[n];
  }
}

bool CrossingWatch::after_tick(std::uint64_t sequence, bool given, std::span<const double> depths,
                               realtime::BlockLog<record::CrossingRow>& log) noexcept {
  bool entered = false;
  for (std::size_t n = 0; n < crossings_.size(); ++n) {
    Crossing& crossing = crossings_[n];
    if (depths[n] > 0.0 && !crossing.on) {
      crossing.on = entered = true;
      crossing.row.begin = sequence;
      crossing.row.given = given;
      crossing.row.depth = 0.0;
    }
    if (depths[n] > 0.0) {
      crossing.row.sequence = sequence;
      crossing.row.depth = std::max(crossing.row.depth, depths[n]);
    } else if (crossing.on) {
      log.push(crossing.row);
      crossing.on = false;
    }
  }
  return entered;
}

void CrossingWatch::end(realtime::BlockLog<record::CrossingRow>& log) noexcept {
  for (Crossing& crossing : crossings_) {
    if (crossing.on) {
      log.push(crossing.row);
      crossing.on = false;
    }
  }
}

}  // namespace haptrial::bone
