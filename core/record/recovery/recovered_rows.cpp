#include "core/record/recovery/recovered_rows.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <set>
#include <tuple>
#include <utility>

#include "core/record/hdf5/deflate.h"
#include "core/record/rows/session_tables.h"

namespace haptrial::record {
namespace {

std::size_t longest_chunk(const TableList& tables) {
  std::size_t bytes = 0;
  for (const TableDescription* table : tables) {
    bytes = std::max(bytes, table->schema().chunk_rows * table->schema().row_bytes());
  }
  return bytes;
}

template <class Row, class Order>
void sort_by(std::vector<Row>& rows, Order order) {
  std::stable_sort(rows.begin(), rows.end(),
                   [&](const Row& a, const Row& b) { return order(a) < order(b); });
}

template <class Row>
std::vector<Row> rows_of(const std::vector<RecoveredTable>& tables, const Table<Row>& table) {
  for (const RecoveredTable& each : tables) {
    if (&each.table() == &table) {
      return each.rows(table);
    }
  }
  return {};
}

std::optional<TimingSummary> summary_of(const std::vector<EventRow>& attributes) {
  TimingSummary summary;
  int found = 0;
  for (const EventRow& row : attributes) {
    for (const auto& [name, count] :
         {std::pair("ticks", &summary.ticks), std::pair("overruns", &summary.overruns),
          std::pair("dropped", &summary.dropped)}) {
      if (row.kind != name) {
        continue;
      }
      *count = std::strtoull(row.text.c_str(), nullptr, 10);
      ++found;
    }
  }
  return found == 3 ? std::optional(summary) : std::nullopt;
}

}  // namespace

RecoveredRows::RecoveredRows(std::span<const std::uint8_t> file, const TableList& tables)
    : samples_(samples_table(), file) {
  TableList all = session_tables();
  all.insert(all.end(), tables.begin(), tables.end());
  std::vector<RecoveredTable> session;
  for (const TableDescription* table : session_tables()) {
    if (table != &samples_table()) {
      session.emplace_back(*table, file);
    }
  }
  for (const TableDescription* table : tables) {
    own.emplace_back(*table, file);
  }
  scan_chunks(
      file, longest_chunk(all), [&](std::uint64_t offset, std::span<const std::uint8_t> raw) {
        const auto take = [&](RecoveredTable& table) { return table.take_if_ours(offset, raw); };
        const auto take_by_ticks = [&](RecoveredTable& table) {
          return table.table().of() == RowsOf::kEachTick && take(table);
        };
        // First those that know their rows by more than a size. /samples last: an older layout may
        // have a chunk of the same size.
        if (!std::any_of(own.begin(), own.end(), take_by_ticks) &&
            !std::any_of(session.begin(), session.end(), take) &&
            !std::any_of(own.begin(), own.end(), take)) {
          take(samples_);
        }
      });
  const auto finish = [&](RecoveredTable& table) {
    table.finish();
    counts[table.table().name()] = table.count();
  };
  finish(samples_);
  std::for_each(session.begin(), session.end(), finish);
  std::for_each(own.begin(), own.end(), finish);
  take_session_rows(session);
}

void RecoveredRows::take_session_rows(const std::vector<RecoveredTable>& session) {
  passes = rows_of(session, trials_table());
  sort_by(passes, [](const PassRow& row) { return row.first_sample; });
  events = joined_events(rows_of(session, events_table()));
  stimuli = rows_of(session, stimuli_table());
  sort_by(stimuli, [](const StimulusRow& row) { return std::pair(row.block, row.time); });
  timing = rows_of(session, timing_table());
  sort_by(timing, [](const TimingRow& row) { return row.bin_low_ns; });
  frames = rows_of(session, frames_table());
  sort_by(frames, [](const FrameRow& row) { return row.time_ns; });
  std::vector<EventPart> parts = rows_of(session, attributes_table());
  sort_by(parts, [](const EventPart& part) { return std::pair(part.row.kind, part.part); });
  attributes = joined_events(std::move(parts));
  summary = summary_of(attributes);
  runs = rows_of(session, runs_table());
  sort_by(runs, [](const RunRow& row) { return std::tuple(row.run, row.counts.ticks, row.state); });
  begun = rows_of(session, begun_table());
  sort_by(begun, [](const BegunRow& row) { return row.row; });
}

std::vector<Sample> RecoveredRows::samples(std::size_t piece) const {
  return samples_.rows(samples_table(), piece);
}

TableList RecoveredRows::tables() const {
  std::set<std::string> groups;
  for (const RecoveredTable& table : own) {
    if (table.count() > 0) {
      groups.insert(table.table().group());
    }
  }
  TableList found;
  for (const RecoveredTable& table : own) {
    if (table.count() > 0 || groups.contains(table.table().group())) {
      found.push_back(&table.table());
    }
  }
  return found;
}

bool RecoveredRows::needs_each_tick() const {
  const TableList found = tables();
  return std::any_of(found.begin(), found.end(), [](const TableDescription* table) {
    return table->of() == RowsOf::kEachTick;
  });
}

namespace {

constexpr std::uint8_t kFirstByte = 0x78;  // deflate with a window of 32 KiB

/// Whether the two bytes can begin a zlib stream without a dictionary (RFC 1950, 2.2).
bool is_header(const std::uint8_t* at) {
  return (at[0] * 256 + at[1]) % 31 == 0 && (at[1] & 0x20) == 0;
}

}  // namespace

void scan_chunks(
    std::span<const std::uint8_t> file, std::size_t longest,
    const std::function<void(std::uint64_t offset, std::span<const std::uint8_t> raw)>& found) {
  std::vector<std::uint8_t> raw(longest);
  Inflater inflater;
  std::size_t at = 0;
  while (at + 2 <= file.size()) {
    const void* next = std::memchr(file.data() + at, kFirstByte, file.size() - at - 1);
    if (next == nullptr) {
      return;
    }
    at = static_cast<std::size_t>(static_cast<const std::uint8_t*>(next) - file.data());
    Inflater::Lengths lengths;
    if (is_header(file.data() + at)) {
      lengths = inflater.decompress_prefix(file.subspan(at), raw);
    }
    if (lengths.raw > 0) {
      found(at, {raw.data(), lengths.raw});
    }
    at += std::max<std::size_t>(lengths.compressed, 1);
  }
}

}  // namespace haptrial::record
