#pragma once

#include <cstdint>
#include <string>

#include "core/record/table/table.h"

namespace haptrial::record {

/// A window that a body of its own rate did not end in time, a row of /late_windows: what was felt
/// until then came from the window before. With these rows a replay feels the same.
struct LateWindowRow {
  std::int32_t pass{0};      // row of /trials
  std::int32_t device{0};    // whose tool, from 0
  std::int32_t interval{1};  // of the trial, from 1
  std::string object;        // its name
  std::uint64_t tick{0};     // of the body, from 0: on which the window was taken
  std::uint64_t ticks{0};    // too late
};

template <>
const Table<LateWindowRow>& table_of<LateWindowRow>();

}  // namespace haptrial::record
