#pragma once

#include <cstdint>
#include <span>

#include "analysis/statistics/base/defined.h"
#include "core/record/read/session_reader_forward.h"
#include "core/record/rows/session_types.h"

namespace haptrial::analysis {

/// Percentiles of one of the loop's histograms: the upper edges of the bins that hold them, so a
/// value is never reported better than it was.
struct TimingPercentiles {
  std::int64_t median_ns{0};
  std::int64_t p99_ns{0};
  std::int64_t p999_ns{0};
  std::int64_t highest_ns{0};
};

/// How one session's servo loop kept time.
struct LoopTiming {
  bool applies{false};   // false on a simulated clock, whose ticks take no time
  bool complete{false};  // the session came to its end, so the counts below exist
  std::uint64_t ticks{0};
  std::uint64_t overruns{0};  // ticks that began after their period had passed
  std::uint64_t dropped{0};   // records that the loop could not hand over
  std::uint64_t missing{0};   // ticks without a row in /samples
  Defined<TimingPercentiles> period{Undefined{"the histogram is empty"}};
  Defined<TimingPercentiles> lateness{Undefined{"the histogram is empty"}};
  Defined<TimingPercentiles> compute{Undefined{"the histogram is empty"}};
};

/// @param rows  bins in ascending order; @param count  the histogram to read.
Defined<TimingPercentiles> percentiles(std::span<const record::TimingRow> rows,
                                       std::uint64_t record::TimingRow::*count);

/// @throws InputError when the file is damaged.
LoopTiming loop_timing(const record::SessionReader& reader);

}  // namespace haptrial::analysis
