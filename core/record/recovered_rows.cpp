#include "core/record/recovered_rows.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <string>
#include <tuple>
#include <utility>

#include "core/record/byte_planes.h"
#include "core/record/chunk_scan.h"
#include "core/record/deflate.h"
#include "core/record/drilling_codec.h"
#include "core/record/row_codec.h"
#include "core/record/run_codec.h"
#include "core/record/schema.h"

namespace haptrial::record {
namespace {

std::size_t chunk_bytes(const TableSchema& schema) {
  return schema.row_bytes() * schema.chunk_rows;
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

/// The chunks of one table of drillings.
template <class Row>
class DrillingChunks {
 public:
  /// @returns whether the chunk is of this table.
  bool take_if_ours(std::span<const std::uint8_t> raw) {
    const TableSchema& table = schema(table_of<Row>());
    if (raw.size() != chunk_bytes(table)) return false;
    chunks_.add(Chunk(raw, table.row_bytes()), get_row<Row>);
    return true;
  }
  template <typename Order>
  std::vector<Row> take(Order order, std::map<std::string, std::uint64_t>& counts) {
    counts[schema(table_of<Row>()).name] = chunks_.count();
    return chunks_.take(order);
  }

 private:
  Chunks<Row> chunks_;
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

RecoveredRows::RecoveredRows(std::span<const std::uint8_t> file) : file_(file) {
  Chunks<PassRow> pass_chunks;
  Chunks<StimulusRow> stimulus_chunks;
  Chunks<TimingRow> timing_chunks;
  Chunks<FrameRow> frame_chunks;
  Chunks<EventPart> attribute_chunks;
  Chunks<RunRow> run_rows;
  Chunks<BegunRow> begun_chunks;
  EventChunks event_chunks;
  std::map<std::uint64_t, Piece> sample_chunks;  // by first sequence number
  std::map<std::uint64_t, Piece> tool_chunks;
  DrillingChunks<RemovalRow> removal_chunks;
  DrillingChunks<CameraRow> camera_chunks;
  DrillingChunks<SplitRow> split_chunks;
  DrillingChunks<BoneRow> bone_chunks;
  DrillingChunks<StructureRow> structure_chunks;
  DrillingChunks<BoneRunRow> run_chunks;
  DrillingChunks<BoneDensityRow> density_chunks;
  DrillingChunks<ProcedureRow> procedure_chunks;
  const std::size_t tool_bytes = schema(DrillingTable::kTool).row_bytes();

  const auto add_samples = [&](std::uint64_t offset, std::span<const std::uint8_t> raw) {
    const Chunk chunk(raw, samples_schema().row_bytes());
    if (chunk.rows == 0) return;
    Sample first;
    get_samples(chunk.planes, 0, {&first, 1});
    Piece& piece = sample_chunks[first.sequence];
    if (chunk.rows >= piece.rows) piece = {offset, chunk.rows, first.sequence};
  };
  const auto add_tool = [&](std::uint64_t offset, std::span<const std::uint8_t> raw) {
    const Chunk chunk(raw, tool_bytes);
    if (chunk.rows == 0) return;
    const auto sequence = get_row<ToolRow>(chunk.planes, 0).sequence;
    Piece& piece = tool_chunks[sequence];
    if (chunk.rows >= piece.rows) piece = {offset, chunk.rows, sequence};
  };
  scan_chunks(file, [&](std::uint64_t offset, std::span<const std::uint8_t> raw) {
    const auto is = [&](const TableSchema& schema) { return raw.size() == chunk_bytes(schema); };
    const auto chunk = [&](const TableSchema& schema) { return Chunk(raw, schema.row_bytes()); };
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
    } else if (removal_chunks.take_if_ours(raw) || camera_chunks.take_if_ours(raw) ||
               split_chunks.take_if_ours(raw) || bone_chunks.take_if_ours(raw) ||
               structure_chunks.take_if_ours(raw) || run_chunks.take_if_ours(raw) ||
               density_chunks.take_if_ours(raw) || procedure_chunks.take_if_ours(raw)) {
      return;
    } else if (raw.size() % (kLiveChunkStep * tool_bytes) == 0) {
      add_tool(offset, raw);
    } else if (raw.size() % (kLiveChunkStep * samples_schema().row_bytes()) == 0) {
      add_samples(offset, raw);
    }
  });

  for (const auto& [sequence, piece] : sample_chunks) pieces_.push_back(piece);
  for (const auto& [sequence, piece] : tool_chunks) tool_pieces_.push_back(piece);
  const auto when = [](const auto& row) { return row.sequence; };
  removals = removal_chunks.take(when, counts);
  camera = camera_chunks.take(when, counts);
  splits = split_chunks.take(when, counts);
  bones = bone_chunks.take([](const BoneRow& row) { return row.bone; }, counts);
  structures = structure_chunks.take(
      [](const StructureRow& row) { return std::pair(row.bone, row.label); }, counts);
  bone_runs =
      run_chunks.take([](const BoneRunRow& row) { return std::pair(row.bone, row.first); }, counts);
  bone_densities = density_chunks.take(
      [](const BoneDensityRow& row) { return std::pair(row.bone, row.voxel); }, counts);
  procedures = procedure_chunks.take([](const ProcedureRow& row) { return row.pass; }, counts);
  counts[samples_schema().name] = 0;
  for (const Piece& piece : pieces_) counts[samples_schema().name] += piece.rows;
  for (const Piece& piece : tool_pieces_) {
    counts[schema(DrillingTable::kTool).name] += piece.rows;
  }
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
  keep_in_order(rows, pieces_, piece);
  return rows;
}

std::vector<ToolRow> RecoveredRows::tool(std::size_t piece) const {
  const Chunk chunk(inflated(tool_pieces_.at(piece)), schema(DrillingTable::kTool).row_bytes());
  std::vector<ToolRow> rows;
  for (std::size_t i = 0; i < tool_pieces_[piece].rows; ++i) {
    rows.push_back(get_row<ToolRow>(chunk.planes, i));
  }
  keep_in_order(rows, tool_pieces_, piece);
  return rows;
}

std::vector<std::uint8_t> RecoveredRows::inflated(const Piece& piece) const {
  const std::size_t most =
      std::max(chunk_bytes(samples_schema()), chunk_bytes(schema(DrillingTable::kTool)));
  std::vector<std::uint8_t> raw(most);
  Inflater inflater;
  raw.resize(inflater.decompress_prefix(file_.subspan(piece.offset), raw).raw);
  return raw;
}

/// A piece never reaches into the next, and zeros before the last row would be rows of no tick.
template <class Row>
void RecoveredRows::keep_in_order(std::vector<Row>& rows, const std::vector<Piece>& pieces,
                                  std::size_t piece) {
  const std::uint64_t end = piece + 1 < pieces.size() ? pieces[piece + 1].first_sequence : ~0ull;
  std::uint64_t last = pieces[piece].first_sequence;
  std::erase_if(rows, [&](const Row& row) {
    const bool wrong = row.sequence < last || row.sequence >= end;
    if (!wrong) last = row.sequence;
    return wrong;
  });
}

}  // namespace haptrial::record
