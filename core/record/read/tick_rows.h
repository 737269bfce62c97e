#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/record/read/session_reader.h"
#include "core/record/rows/session_tables.h"
#include "core/record/rows/session_types.h"

namespace haptrial::record {

/// Visits every row of /samples in order, a piece of the file in memory at a time.
template <class Visit>
void each_sample(const SessionReader& reader, Visit visit) {
  constexpr std::uint64_t kPiece = 65536;  // rows
  const std::uint64_t count = reader.sample_count();
  for (std::uint64_t first = 0; first < count; first += kPiece) {
    for (const Sample& sample : reader.samples(first, std::min(kPiece, count - first))) {
      visit(sample);
    }
  }
}

/// The first row of a tick that is not before `tick`. Where no row is missing it is found at once.
/// @param table  whose rows have ascending numbers `sequence` of ticks
template <class Row>
std::uint64_t row_of_tick(const SessionReader& reader, const Table<Row>& table,
                          std::uint64_t tick) {
  const auto at = [&](std::uint64_t row) {
    return static_cast<std::uint64_t>(reader.integers(table, "sequence", row, 1).front());
  };
  std::uint64_t high = reader.count(table);
  if (high == 0 || tick <= at(0)) {
    return 0;
  }
  const std::uint64_t likely = tick - at(0);
  if (likely < high && at(likely) == tick) {
    return likely;
  }
  std::uint64_t low = 1;
  while (low < high) {
    const std::uint64_t middle = low + (high - low) / 2;
    at(middle) < tick ? low = middle + 1 : high = middle;
  }
  return low;
}

/// Rows of a table that follow one another.
struct RowSpan {
  std::uint64_t first{0};
  std::uint64_t count{0};
};

/// The rows of `count` ticks from `first` on; rows that are missing are left out.
template <class Row>
RowSpan span_of_ticks(const SessionReader& reader, const Table<Row>& table, std::uint64_t first,
                      std::uint64_t count) {
  const std::uint64_t row = row_of_tick(reader, table, first);
  return {row, row_of_tick(reader, table, first + count) - row};
}

template <class Row>
std::vector<Row> rows_of_ticks(const SessionReader& reader, const Table<Row>& table,
                               std::uint64_t first, std::uint64_t count) {
  const RowSpan span = span_of_ticks(reader, table, first, count);
  return reader.rows(table, span.first, span.count);
}

/// Where the samples of a pass are in /samples, and in every other table with a row for each tick.
/// @throws InputError if some of them are missing, or all
RowSpan span_of_pass(const SessionReader& reader, const PassRow& pass);

/// @throws InputError likewise
inline std::vector<Sample> samples_of_pass(const SessionReader& reader, const PassRow& pass) {
  const RowSpan span = span_of_pass(reader, pass);
  return reader.samples(span.first, span.count);
}

/// Takes the last row of a block's stimulus away where it follows sooner than the others follow
/// each other: it is the end of the run, which need not lie on the even time base. For whoever
/// needs even rows; scores are defined over them, as in files of older versions, which lack that
/// row.
inline void keep_even(std::vector<StimulusRow>& rows) {
  constexpr double kRounding = 1e-6;  // of a step
  if (rows.size() < 3) {
    return;
  }
  const double step = rows[1].time - rows[0].time;
  const double last = rows.back().time - rows[rows.size() - 2].time;
  if (last < (1.0 - kRounding) * step) {
    rows.pop_back();
  }
}

}  // namespace haptrial::record
