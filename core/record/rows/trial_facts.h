#pragma once

#include <cstdint>

#include "core/record/table/table.h"

namespace haptrial::record {

/// A trial that the experimenter skipped for good, a row of /skipped.
struct SkippedRow {
  std::int64_t time_ns{0};  // since the first tick of the session
  std::int32_t trial{0};    // as in /trials
  bool practice{false};
  friend bool operator==(const SkippedRow&, const SkippedRow&) = default;
};

/// A pass during whose run the hand did not carry all the damping, a row of /damping.
struct DampingRow {
  std::int64_t time_ns{0};  // of the end of the pass, before the next one begins
  std::int32_t trial{0};
  double least{1.0};    // share of the damping that the definition asks for
  double seconds{0.0};  // of the run, for which it was reduced [s]
};

template <>
const Table<SkippedRow>& table_of<SkippedRow>();
template <>
const Table<DampingRow>& table_of<DampingRow>();

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
