#include "core/record/recovered_rows.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <utility>

#include "core/record/byte_planes.h"
#include "core/record/chunk_scan.h"
#include "core/record/deflate.h"
#include "core/record/row_codec.h"
#include "core/record/run_codec.h"
#include "core/record/schema.h"

namespace haptrial::record {
namespace {

std::size_t chunk_bytes(const TableSchema& schema) {
  return schema.row_bytes() * schema.chunk_rows;
}

std::size_t longest_chunk(const TableList& tables) {
  std::size_t bytes = 0;
  for (const TableSchema* each :
       {&samples_schema(), &trials_schema(), &events_schema(), &stimuli_schema(), &timing_schema(),
        &frames_schema(), &attributes_schema(), &runs_schema(), &begun_schema()}) {
    bytes = std::max(bytes, chunk_bytes(*each));
  }
  for (const TableDescription* each : tables) {
    bytes = std::max(bytes, chunk_bytes(each->schema()));
  }
  return bytes;
}

/// The chunk's rows without the zeros behind them.
struct Chunk {
  Chunk(std::span<const std::uint8_t> raw, std::size_t row_bytes)
      : planes(row_bytes, raw.size() / row_bytes), rows(0) {
    std::memcpy(planes.data(), raw.data(), raw.size());
    rows = planes.rows_in_use();
  }
  /// The first row, which a chunk keeps when it is written again with more rows.
  std::string key() const {
    std::string bytes(planes.row_bytes(), '\0');
    planes.get_row(0, {reinterpret_cast<std::uint8_t*>(bytes.data()), bytes.size()});
    return bytes;
  }

  BytePlanes planes;
  std::size_t rows;
};

/// Rows of one table, chunk by chunk; of several copies of a chunk the one with most rows.
template <typename Row>
class Chunks {
 public:
  void add(const Chunk& chunk, Row (*get)(const BytePlanes&, std::size_t)) {
    if (chunk.rows == 0) return;
    std::vector<Row>& rows = by_key_[chunk.key()];
    if (chunk.rows < rows.size()) return;
    rows.clear();
    for (std::size_t i = 0; i < chunk.rows; ++i) rows.push_back(get(chunk.planes, i));
  }

  /// @param order  a key that grows along the table
  template <typename Order>
  std::vector<Row> take(Order order) {
    std::vector<Row> all;
    for (auto& [key, rows] : by_key_) all.insert(all.end(), rows.begin(), rows.end());
    std::stable_sort(all.begin(), all.end(),
                     [&](const Row& a, const Row& b) { return order(a) < order(b); });
    return all;
  }
  std::uint64_t count() const {
    std::uint64_t rows = 0;
    for (const auto& [key, chunk] : by_key_) rows += chunk.size();
    return rows;
  }

 private:
  std::map<std::string, std::vector<Row>> by_key_;
};

/// Events in the order of their chunks: several may have one time, so chunks are sorted, not rows.
class EventChunks {
 public:
  void add(const Chunk& chunk) {
    if (chunk.rows == 0) return;
    std::vector<EventPart>& rows = by_key_[chunk.key()];
    if (chunk.rows < rows.size()) return;
    rows.clear();
    for (std::size_t i = 0; i < chunk.rows; ++i) rows.push_back(get_event(chunk.planes, i));
  }
  std::uint64_t count() const {
    std::uint64_t rows = 0;
    for (const auto& [key, chunk] : by_key_) rows += chunk.size();
    return rows;
  }
  std::vector<EventRow> take() {
    std::vector<std::vector<EventPart>> chunks;
    for (auto& [key, rows] : by_key_) chunks.push_back(std::move(rows));
    const auto key = [](const std::vector<EventPart>& rows) {
      return std::pair(rows.front().row.time_ns, rows.front().part);
    };
    std::stable_sort(chunks.begin(), chunks.end(),
                     [&](const auto& a, const auto& b) { return key(a) < key(b); });
    std::vector<EventPart> all;
    for (auto& rows : chunks) all.insert(all.end(), rows.begin(), rows.end());
    return joined_events(std::move(all));
  }

 private:
  std::map<std::string, std::vector<EventPart>> by_key_;
};

bool is_pass_chunk_1(const Chunk& chunk) {
  const std::size_t phase = trials_schema_1().offset("phase");
  const std::string row = chunk.rows > 0 ? chunk.key() : "";
  return row.compare(phase, 8, "training") == 0 ||
         row.compare(phase, 5, std::string("test\0", 5)) == 0;
}

std::optional<TimingSummary> summary_of(const std::vector<EventRow>& attributes) {
  TimingSummary summary;
  int found = 0;
  for (const EventRow& row : attributes) {
    for (const auto& [name, count] :
         {std::pair("ticks", &summary.ticks), std::pair("overruns", &summary.overruns),
          std::pair("dropped", &summary.dropped)}) {
      if (row.kind != name) continue;
      *count = std::strtoull(row.text.c_str(), nullptr, 10);
      ++found;
    }
  }
  return found == 3 ? std::optional(summary) : std::nullopt;
}

}  // namespace

RecoveredRows::RecoveredRows(std::span<const std::uint8_t> file, const TableList& tables)
    : file_(file) {
  for (const TableDescription* table : tables) {
    own.emplace_back(*table, file);
  }
  Chunks<PassRow> pass_chunks;
  Chunks<StimulusRow> stimulus_chunks;
  Chunks<TimingRow> timing_chunks;
  Chunks<FrameRow> frame_chunks;
  Chunks<EventPart> attribute_chunks;
  Chunks<RunRow> run_rows;
  Chunks<BegunRow> begun_chunks;
  EventChunks event_chunks;
  std::map<std::uint64_t, Piece> sample_chunks;  // by first sequence number
  const auto add_samples = [&](std::uint64_t offset, std::span<const std::uint8_t> raw) {
    const Chunk chunk(raw, samples_schema().row_bytes());
    if (chunk.rows == 0) return;
    Sample first;
    get_samples(chunk.planes, 0, {&first, 1});
    Piece& piece = sample_chunks[first.sequence];
    if (chunk.rows >= piece.rows) piece = {offset, chunk.rows, first.sequence};
  };
  const auto add_own = [&](std::uint64_t offset, std::span<const std::uint8_t> raw) {
    return std::any_of(own.begin(), own.end(),
                       [&](RecoveredTable& table) { return table.take_if_ours(offset, raw); });
  };
  scan_chunks(file, longest_chunk(tables),
              [&](std::uint64_t offset, std::span<const std::uint8_t> raw) {
                const auto is = [&](const TableSchema& schema) {
                  return raw.size() == chunk_bytes(schema);
                };
                const auto chunk = [&](const TableSchema& schema) {
                  return Chunk(raw, schema.row_bytes());
                };
                if (is(trials_schema())) {
                  pass_chunks.add(chunk(trials_schema()), get_pass);
                } else if (is(trials_schema_1()) && is_pass_chunk_1(chunk(trials_schema_1()))) {
                  pass_chunks.add(chunk(trials_schema_1()), get_pass_1);
                } else if (is(events_schema())) {
                  event_chunks.add(chunk(events_schema()));
                } else if (is(stimuli_schema())) {
                  stimulus_chunks.add(chunk(stimuli_schema()), get_stimulus);
                } else if (is(timing_schema())) {
                  timing_chunks.add(chunk(timing_schema()), get_timing);
                } else if (is(frames_schema())) {
                  frame_chunks.add(chunk(frames_schema()), get_frame);
                } else if (is(attributes_schema())) {
                  attribute_chunks.add(chunk(attributes_schema()), get_attribute);
                } else if (is(runs_schema())) {
                  run_rows.add(chunk(runs_schema()), get_run);
                } else if (is(begun_schema())) {
                  begun_chunks.add(chunk(begun_schema()), get_begun);
                } else if (add_own(offset, raw)) {
                  return;
                } else if (raw.size() % (kLiveChunkStep * samples_schema().row_bytes()) == 0) {
                  add_samples(offset, raw);
                }
              });

  for (const auto& [sequence, piece] : sample_chunks) pieces_.push_back(piece);
  for (RecoveredTable& table : own) {
    table.finish();
    counts[table.table().name()] = table.count();
  }
  counts[samples_schema().name] = 0;
  for (const Piece& piece : pieces_) counts[samples_schema().name] += piece.rows;
  counts[trials_schema().name] = pass_chunks.count();
  counts[events_schema().name] = event_chunks.count();
  counts[stimuli_schema().name] = stimulus_chunks.count();
  counts[timing_schema().name] = timing_chunks.count();
  counts[frames_schema().name] = frame_chunks.count();
  counts[attributes_schema().name] = attribute_chunks.count();
  counts[runs_schema().name] = run_rows.count();
  counts[begun_schema().name] = begun_chunks.count();
  runs = run_rows.take(
      [](const RunRow& row) { return std::tuple(row.run, row.counts.ticks, row.state); });
  begun = begun_chunks.take([](const BegunRow& row) { return row.row; });
  passes = pass_chunks.take([](const PassRow& row) { return row.first_sample; });
  events = event_chunks.take();
  stimuli =
      stimulus_chunks.take([](const StimulusRow& row) { return std::pair(row.block, row.time); });
  timing = timing_chunks.take([](const TimingRow& row) { return row.bin_low_ns; });
  frames = frame_chunks.take([](const FrameRow& row) { return row.time_ns; });
  attributes = joined_events(attribute_chunks.take(
      [](const EventPart& part) { return std::pair(part.row.kind, part.part); }));
  summary = summary_of(attributes);
}

std::vector<Sample> RecoveredRows::samples(std::size_t piece) const {
  std::vector<Sample> rows(pieces_.at(piece).rows);
  get_samples(Chunk(inflated(pieces_[piece]), samples_schema().row_bytes()).planes, 0, rows);
  keep_in_order(rows, piece);
  return rows;
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

std::vector<std::uint8_t> RecoveredRows::inflated(const Piece& piece) const {
  std::vector<std::uint8_t> raw(chunk_bytes(samples_schema()));
  Inflater inflater;
  raw.resize(inflater.decompress_prefix(file_.subspan(piece.offset), raw).raw);
  return raw;
}

/// A piece never reaches into the next, and zeros before the last row would be rows of no tick.
void RecoveredRows::keep_in_order(std::vector<Sample>& rows, std::size_t piece) const {
  const std::uint64_t end = piece + 1 < pieces_.size() ? pieces_[piece + 1].first_sequence : ~0ull;
  std::uint64_t last = pieces_[piece].first_sequence;
  std::erase_if(rows, [&](const Sample& row) {
    const bool wrong = row.sequence < last || row.sequence >= end;
    if (!wrong) last = row.sequence;
    return wrong;
  });
}

}  // namespace haptrial::record
