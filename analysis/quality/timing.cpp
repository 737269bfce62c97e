#include "analysis/quality/timing.h"

#include <algorithm>
#include <cmath>

#include "core/record/read/session_reader.h"

namespace haptrial::analysis {
namespace {

// The upper edge of the first bin up to which at least `wanted` counts lie.
std::int64_t edge_of(std::span<const record::TimingRow> rows,
                     std::uint64_t record::TimingRow::*count, std::uint64_t wanted) {
  std::uint64_t seen = 0;
  for (const auto& row : rows) {
    seen += row.*count;
    if (seen >= wanted) {
      return row.bin_high_ns;
    }
  }
  return rows.back().bin_high_ns;
}

}  // namespace

Defined<TimingPercentiles> percentiles(std::span<const record::TimingRow> rows,
                                       std::uint64_t record::TimingRow::*count) {
  std::uint64_t total = 0;
  for (const auto& row : rows) {
    total += row.*count;
  }
  if (total == 0) {
    return Undefined{"the histogram is empty"};
  }
  const auto at = [&](double fraction) {
    const auto wanted = std::ceil(fraction * static_cast<double>(total));
    return edge_of(rows, count, static_cast<std::uint64_t>(wanted));
  };
  return TimingPercentiles{at(0.5), at(0.99), at(0.999), edge_of(rows, count, total)};
}

LoopTiming loop_timing(const record::SessionReader& reader) {
  LoopTiming timing;
  timing.applies = reader.info().clock != "simulated";
  if (const auto summary = reader.timing_summary()) {
    timing.complete = true;
    timing.ticks = summary->ticks;
    timing.overruns = summary->overruns;
    timing.dropped = summary->dropped;
    timing.missing = summary->ticks - std::min(summary->ticks, reader.sample_count());
  }
  const auto rows = reader.timing();
  timing.period = percentiles(rows, &record::TimingRow::period_count);
  timing.lateness = percentiles(rows, &record::TimingRow::lateness_count);
  timing.compute = percentiles(rows, &record::TimingRow::compute_count);
  return timing;
}

}  // namespace haptrial::analysis
