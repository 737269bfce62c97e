#pragma once

#include <cstdint>

#include "core/record/table/table.h"

namespace haptrial::record {

/// A pass whose answers the experimenter took back, a row of /taken_back. Its row of /trials stays
/// as it was written; the trial is presented again.
struct TakenBackRow {
  std::int64_t time_ns{0};  // since the first tick of the session
  std::int32_t trial{0};    // as in /trials
  std::int32_t pass{0};     // row of /trials
};

template <>
const Table<TakenBackRow>& table_of<TakenBackRow>();

}  // namespace haptrial::record
