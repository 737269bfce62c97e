#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/bone/hint/hint_setup.h"
#include "core/record/rows/rows.h"
#include "core/record/table/table.h"

namespace haptrial::record {

/// A hint that has ended, a row of /hints.
struct HintRow {
  std::uint64_t sequence{0};  // of the tick on which it ended
  std::uint64_t begin{0};     // of the tick whose removal began it
  hint::HintKind kind{hint::HintKind::kForce};
  bool shown{false};         // to the participant
  std::int32_t removals{0};  // that were faulty, those that began it among them
  // Facts at the removal that was worst, the first of equally bad ones.
  std::string structure;    // nearest one; empty: none within reach
  double distance{0.0};     // from it; 0: none within reach [m]
  double force{0.0};        // [N]
  double speed{0.0};        // [m/s]
  double limit_force{0.0};  // 0: none is known there [N]
  double limit_speed{0.0};  // likewise [m/s]
};

/// Safe values at [from, to) from a structure, a row of /hint_limits.
struct HintLimitRow {
  std::int32_t limit{0};  // from 0
  std::string structure;
  double from{0.0}, to{0.0};  // [m]
  double force{0.0};          // [N]
  double speed{0.0};          // [m/s]
  std::int32_t experts{0};    // from whom it was learned
  bool simulated{false};      // one of them was a program

  bool operator==(const HintLimitRow&) const = default;
};

template <>
const Table<HintRow>& table_of<HintRow>();
template <>
const Table<HintLimitRow>& table_of<HintLimitRow>();

/// The tables of hints, in the order in which they are created.
const TableList& hint_tables();

/// The limits that a session's hints go by.
std::vector<HintLimitRow> limit_rows(const hint::SafeLimits& limits);

}  // namespace haptrial::record
