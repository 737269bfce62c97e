#include "core/record/session_resume.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/record/drilling_codec.h"
#include "core/record/schema.h"
#include "core/record/session_reader.h"
#include "core/record/session_target.h"
#include "core/record/session_writer_impl.h"

namespace haptrial::record {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kTailChunks =
    2;  // what a kill can at most leave half written, and one more

[[noreturn]] void refuse(const fs::path& partial, const std::string& found) {
  throw InputError(partial.string() + ": " + found +
                   "; allowed: an unfinished session that is whole up to its end (haptrial "
                   "recover saves what a damaged one holds)");
}

/// Reads every chunk of samples and notes the last row, and where a pass without a row in /trials
/// lies.
class SampleWalk {
 public:
  SampleWalk(const SessionReader& reader, Resumed& found) : reader_(reader), found_(found) {}

  void run() {
    std::uint64_t rows = reader_.sample_count();
    if (reader_.drills()) rows = std::min(rows, reader_.count<ToolRow>());
    const std::uint64_t chunk = reader_.chunk_rows();
    while (found_.rows < rows && take(found_.rows, std::min(chunk, rows - found_.rows))) {
    }
    found_.dropped_rows = reader_.sample_count() - found_.rows;
    if (found_.dropped_rows > kTailChunks * chunk) {
      refuse(reader_.path(),
             "rows of /samples from " + std::to_string(found_.rows) + " on cannot be read");
    }
  }

  /// The passes that the samples name, each from its first to its last sample.
  const std::vector<OpenPass>& passes() const { return passes_; }

 private:
  bool take(std::uint64_t first, std::uint64_t count) {
    std::vector<Sample> samples;
    try {
      samples = reader_.samples(first, count);
    } catch (const InputError&) {
      return false;
    }
    for (const Sample& sample : samples) note(sample);
    found_.rows += count;
    found_.next_sequence = samples.back().sequence + 1;
    found_.last_time_ns = samples.back().time_ns;
    return true;
  }

  void note(const Sample& sample) {
    if (sample.pass < 0) return;
    if (passes_.empty() || passes_.back().row != sample.pass) {
      passes_.push_back({sample.pass, sample.sequence, sample.sequence});
    }
    passes_.back().last_sample = sample.sequence;
  }

  const SessionReader& reader_;
  Resumed& found_;
  std::vector<OpenPass> passes_;
};

/// How many rows from the beginning are of ticks before `end`. Those of a chunk that cannot be read
/// are not.
template <class Row>
std::uint64_t rows_before(const SessionReader& reader, std::uint64_t end) {
  std::uint64_t kept = 0;
  const std::uint64_t count = reader.count<Row>();
  const std::uint64_t piece = schema(table_of<Row>()).chunk_rows;
  while (kept < count) {
    std::vector<Row> rows;
    try {
      rows = reader.rows<Row>(kept, std::min(piece, count - kept));
    } catch (const InputError&) {
      break;
    }
    for (const Row& row : rows) {
      if (row.sequence >= end) return kept;
      ++kept;
    }
  }
  return kept;
}

void examine_drilling(const SessionReader& reader, const Resumed& found, KeptRows& rows) {
  rows.drills = reader.drills();
  if (!rows.drills) return;
  const auto kept = [&](DrillingTable table) -> std::uint64_t& {
    return rows.drilling[static_cast<std::size_t>(table)];
  };
  kept(DrillingTable::kTool) = found.rows;
  kept(DrillingTable::kRemovals) = rows_before<RemovalRow>(reader, found.next_sequence);
  kept(DrillingTable::kCamera) = rows_before<CameraRow>(reader, found.next_sequence);
  kept(DrillingTable::kSplits) = rows_before<SplitRow>(reader, found.next_sequence);
  kept(DrillingTable::kBones) = reader.count<BoneRow>();
  kept(DrillingTable::kStructures) = reader.count<StructureRow>();
  kept(DrillingTable::kBoneRuns) = reader.count<BoneRunRow>();
  kept(DrillingTable::kBoneDensities) = reader.count<BoneDensityRow>();
  for (const ProcedureRow& row : reader.rows<ProcedureRow>()) {
    if (row.pass < static_cast<std::int32_t>(found.passes.size())) {
      ++kept(DrillingTable::kProcedures);
    }
  }
}

Resumed examine(const fs::path& partial, KeptRows& rows) {
  const SessionReader reader(partial);
  if (reader.version() != kSchemaVersion) {
    refuse(partial, "is of schema version " + std::to_string(reader.version()));
  }
  Resumed found;
  found.info = reader.info();
  SampleWalk walk(reader, found);
  walk.run();
  for (const PassRow& pass : reader.passes()) {
    if (found.dropped_passes == 0 && pass.last_sample < found.next_sequence) {
      found.passes.push_back(pass);
    } else {
      ++found.dropped_passes;
    }
  }
  for (const OpenPass& pass : walk.passes()) {
    if (pass.row >= static_cast<std::int32_t>(found.passes.size())) {
      found.open_passes.push_back(pass);
    }
  }
  found.events = reader.events();
  const std::vector<StimulusRow> stimuli = reader.stimuli();
  for (const StimulusRow& row : stimuli) {
    if (found.blocks.empty() || found.blocks.back() != row.block) found.blocks.push_back(row.block);
  }
  found.ended = reader.timing_summary().has_value();
  rows.samples = found.rows;
  rows.frames = reader.frames().size();
  rows.trials = found.passes.size();
  rows.events = reader.event_rows();
  rows.stimuli = stimuli.size();
  rows.timing = found.ended ? reader.timing().size() : 0;
  rows.attributes = reader.attribute_rows();
  examine_drilling(reader, found, rows);
  return found;
}

}  // namespace

bool SessionWriter::can_resume(const fs::path& final_path) {
  std::error_code ignored;
  if (fs::exists(final_path, ignored)) {
    throw InputError(final_path.string() +
                     ": the session is complete; allowed: a session that did not end");
  }
  return fs::exists(partial_path(final_path), ignored);
}

SessionWriter SessionWriter::resume(const fs::path& final_path, Resumed& found) {
  const fs::path partial = partial_path(final_path);
  if (!can_resume(final_path)) {
    throw InputError(partial.string() + ": no such file; allowed: a session that did not end");
  }
  FileLock lock = FileLock::take(partial, false);
  KeptRows rows;
  try {
    found = examine(partial, rows);
  } catch (const InputError& error) {
    const std::string what = error.what();
    if (what.find("haptrial recover") != std::string::npos) throw;
    throw InputError(what + " (haptrial recover saves what a damaged one holds)");
  }
  try {
    auto impl = std::make_unique<Impl>(final_path, found.info, std::move(lock), rows);
    impl->earlier_ticks = found.rows;
    impl->has_timing = found.ended;
    return SessionWriter(std::move(impl));
  } catch (const h5::Error& error) {
    refuse(partial, std::string("cannot be written (") + error.what() + ")");
  }
}

}  // namespace haptrial::record
