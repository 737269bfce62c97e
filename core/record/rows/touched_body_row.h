#pragma once

#include <cstdint>
#include <string>

#include "core/record/table/table.h"

namespace haptrial::record {

/// How the contact with a body that gives way went in a pass, a row of /touched_bodies. Counts are
/// ticks.
struct TouchedBodyRow {
  std::int32_t pass{0};        // row of /trials
  std::int32_t device{0};      // whose tool, from 0
  std::string object;          // its name
  std::uint64_t contact{0};    // in contact
  std::uint64_t inverted{0};   // a tetrahedron would be inside out: the force stayed below that
  std::uint64_t unsettled{0};  // the places of contact were not found to rounding
  std::uint64_t crowded{0};    // more places than fit: the deepest were taken
};

template <>
const Table<TouchedBodyRow>& table_of<TouchedBodyRow>();

}  // namespace haptrial::record
