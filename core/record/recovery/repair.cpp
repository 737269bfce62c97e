#include "core/record/recovery/repair.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/exception_words.h"
#include "core/record/hdf5/hdf5_layer.h"
#include "core/record/hdf5/session_target.h"
#include "core/record/read/session_reader.h"
#include "core/record/read/tick_rows.h"
#include "core/record/recovery/rewrite.h"
#include "core/record/recovery/tick_ranges.h"
#include "core/record/rows/common_tables.h"
#include "core/record/rows/session_tables.h"
#include "core/record/table/schema.h"

namespace haptrial::record {
namespace {

namespace fs = std::filesystem;

/// The samples that were found of a pass.
struct SeenPass {
  std::uint64_t first{0}, last{0}, count{0};
};

/// The ticks that are kept, and the passes that they make.
class Plan {
 public:
  explicit Plan(const RecoveredRows& rows) : rows_(rows), each_tick_(rows.needs_each_tick()) {
    find_ticks();
    find_passes();
  }

  /// The next run takes the numbers behind the last tick, so that no row of one may stay there.
  bool keeps(std::uint64_t sequence) const {
    return sequence < end_ && (!each_tick_ || ticks_.holds(sequence, sequence));
  }
  const std::vector<PassRow>& passes() const { return passes_; }
  std::uint64_t dropped_passes() const { return dropped_passes_; }

 private:
  static TickRanges ticks_of(const RecoveredTable& table) {
    TickRanges ticks;
    const std::size_t bytes = table.table().schema().row_bytes();
    for (std::size_t i = 0; i < table.pieces(); ++i) {
      const std::vector<std::uint8_t> rows = table.piece(i);
      for (std::size_t at = 0; at < rows.size(); at += bytes) {
        const std::int64_t sequence = table.table().integer(rows.data() + at, "sequence");
        ticks.add(static_cast<std::uint64_t>(sequence));
      }
    }
    return ticks;
  }

  void find_ticks() {
    for (std::size_t i = 0; i < rows_.sample_pieces(); ++i) {
      for (const Sample& sample : rows_.samples(i)) {
        ticks_.add(sample.sequence);
      }
    }
    // Only tables that the session had count: one that it may have had and has no rows of says
    // nothing.
    const TableList had = rows_.tables();
    for (const RecoveredTable& table : rows_.own) {
      const bool counts = std::find(had.begin(), had.end(), &table.table()) != had.end();
      if (each_tick_ && counts && table.table().of() == RowsOf::kEachTick) {
        ticks_ = ticks_.shared_with(ticks_of(table));
      }
    }
    if (ticks_.ranges().empty()) {
      return;
    }
    if (!each_tick_) {
      end_ = ticks_.ranges().back().last + 1;
      return;
    }
    std::uint64_t whole = ticks_.ranges().front().first;
    for (const PassRow& pass : rows_.passes) {
      if (ticks_.holds(pass.first_sample, pass.last_sample)) {
        whole = std::max(whole, pass.last_sample);
      }
    }
    end_ = ticks_.end_of_range(whole) + 1;
  }

  std::map<std::int32_t, SeenPass> seen_passes() const {
    std::map<std::int32_t, SeenPass> seen;
    for (std::size_t i = 0; i < rows_.sample_pieces(); ++i) {
      for (const Sample& sample : rows_.samples(i)) {
        if (sample.pass < 0 || !keeps(sample.sequence)) {
          continue;
        }
        SeenPass& pass = seen[sample.pass];
        if (pass.count++ == 0) {
          pass.first = sample.sequence;
        }
        pass.last = sample.sequence;
      }
    }
    return seen;
  }

  /// The number of a row of /trials: its samples say it, and without any its place.
  static std::int32_t number_of(const PassRow& row, std::size_t place,
                                const std::map<std::int32_t, SeenPass>& seen) {
    for (const auto& [number, pass] : seen) {
      if (row.first_sample <= pass.first && pass.last <= row.last_sample) {
        return number;
      }
    }
    return static_cast<std::int32_t>(place);
  }

  void find_passes() {
    const std::map<std::int32_t, SeenPass> seen = seen_passes();
    std::map<std::int32_t, PassRow> known;
    for (const BegunRow& begun : rows_.begun) {
      known[begun.row] = begun.pass;
    }
    std::int32_t end = 0;  // behind the last pass that is whole or followed: the rest is open
    std::map<std::int32_t, bool> whole;
    for (std::size_t i = 0; i < rows_.passes.size(); ++i) {
      const PassRow& row = rows_.passes[i];
      const std::int32_t number = number_of(row, i, seen);
      const auto at = seen.find(number);
      known[number] = row;
      whole[number] = row.first_sample <= row.last_sample && at != seen.end() &&
                      at->second.count == row.last_sample - row.first_sample + 1;
      dropped_passes_ += whole[number] ? 0 : 1;
      const bool followed = !each_tick_ && !seen.empty() && seen.rbegin()->first > number;
      if (whole[number] || followed) {
        end = std::max(end, number + 1);
      }
    }
    for (std::int32_t number = 0; number < end; ++number) {
      PassRow row = known[number];
      if (!whole[number]) {
        const auto at = seen.find(number);
        const std::uint64_t next = passes_.empty() ? 0 : passes_.back().last_sample + 1;
        row.first_sample = at != seen.end() ? at->second.first : next;
        row.last_sample = at != seen.end() ? at->second.last : next;
        row.status = row.status == PassStatus::kCompleted ? PassStatus::kDamaged : row.status;
      }
      passes_.push_back(row);
    }
  }

  const RecoveredRows& rows_;
  bool each_tick_;
  TickRanges ticks_;
  std::uint64_t end_{0};  // behind the last tick that is kept
  std::vector<PassRow> passes_;
  std::uint64_t dropped_passes_{0};
};

/// Result of the samples on their way to the new file.
struct Written {
  std::uint64_t samples{0}, missing{0}, next{0};
  std::int64_t last_time{0};
  void add(std::span<const Sample> rows) {
    for (const Sample& row : rows) {
      missing += row.sequence - next;
      next = row.sequence + 1;
      last_time = row.time_ns;
      ++samples;
    }
  }
};

fs::path with(const fs::path& path, const std::string& ending) {
  fs::path result = path;
  result += ending;
  return result;
}

/// A name for the damaged file: one of its own, or the one that a repair that was cut short gave
/// it.
fs::path name_for_damaged(const fs::path& partial) {
  for (int number = 1;; ++number) {
    const fs::path name =
        with(partial, number == 1 ? ".damaged" : fmt::format(".damaged-{}", number));
    std::error_code error;
    if (!fs::exists(name, error) || fs::equivalent(name, partial, error)) {
      return name;
    }
  }
}

void keep_damaged(const fs::path& partial, const fs::path& damaged) {
  std::error_code error;
  if (fs::exists(damaged, error)) {
    return;
  }
  fs::create_hard_link(partial, damaged, error);
  if (!error) {
    return;
  }
  fs::copy_file(partial, damaged, error);
  if (error) {
    throw RunError(damaged.string() + ": cannot be written (" + error.message() + ")");
  }
  sync_file(damaged);
}

void write_repaired(SessionWriter writer, const RecoveredRows& rows, const Plan& plan,
                    const std::function<std::string(const Written&)>& sentence) {
  Written written;
  write_rows(
      writer, rows, [&](std::uint64_t sequence) { return plan.keeps(sequence); },
      [&](std::span<const Sample> samples) { written.add(samples); });
  for (const PassRow& pass : plan.passes()) {
    writer.add_pass(pass);
  }
  write_rows_of_passes(writer, rows, plan.passes().size(), plan.passes().size());
  const bool told_ended = !rows.runs.empty() && rows.runs.back().state == RunState::kEnded;
  if (rows.summary && !told_ended) {  // of a schema version without /runs
    const RunRow ended{1, 0, *rows.summary, -1, RunState::kEnded};
    writer.keep_runs(std::span(&ended, 1));
  }
  writer.keep_timing(rows.timing);
  const std::int64_t last_event = rows.events.empty() ? 0 : rows.events.back().time_ns;
  writer.add_event({std::max(last_event, written.last_time), "repaired", sentence(written)});
  writer.close();
}

/// Rows of a table of a protocol that nothing in /samples or /trials goes with.
/// @param end  behind the last tick  @param passes, sampled  rows of /trials; passes that samples
/// name, too: a row of any other would be taken for one of the next pass
std::optional<std::string> wrong_in(const TableDescription& table, const SessionReader& reader,
                                    std::uint64_t end, std::size_t passes, std::size_t sampled) {
  const std::uint64_t count = reader.count(table);
  if (table.of() == RowsOf::kEachTick && count != reader.sample_count()) {
    return fmt::format("/{} has {} rows, and /samples {}", table.name(), count,
                       reader.sample_count());
  }
  if (table.of() == RowsOf::kTick && count > 0 &&
      static_cast<std::uint64_t>(reader.integers(table, "sequence", count - 1, 1).front()) >= end) {
    return fmt::format("/{} refers to ticks that are missing", table.name());
  }
  if (table.of() != RowsOf::kEndedPass && table.of() != RowsOf::kPass) {
    return std::nullopt;
  }
  const bool ended = table.of() == RowsOf::kEndedPass;
  if (!ended && reader.sample_count() == 0) {
    return std::nullopt;  // the rows that stand here are all that is left
  }
  for (const std::int64_t pass : reader.integers(table, "pass", 0, count)) {
    if (pass >= static_cast<std::int64_t>(ended ? passes : std::max(passes, sampled))) {
      return fmt::format("pass {} of /{} is not in /{}", pass, table.name(),
                         ended ? "trials" : "samples");
    }
  }
  return std::nullopt;
}

/// Contradiction between the rows of a file that has all its chunks; nothing if all agree.
std::optional<std::string> wrong_between_rows(const SessionReader& reader,
                                              const TableList& tables) {
  std::uint64_t next = 0;
  std::size_t sampled = 0;  // passes
  std::optional<std::string> wrong;
  each_sample(reader, [&](const Sample& sample) {
    sampled = std::max(sampled, static_cast<std::size_t>(sample.pass + 1));
    if (sample.sequence < next && !wrong) {
      wrong = fmt::format("sequence number {} of /samples follows {}", sample.sequence, next - 1);
    }
    next = sample.sequence + 1;
  });
  if (wrong) {
    return wrong;
  }
  const std::vector<PassRow> passes = reader.passes();
  for (std::size_t i = 0; i < passes.size(); ++i) {
    if (passes[i].last_sample >= next) {
      return fmt::format("samples of pass {} are missing", i);
    }
  }
  for (const TableDescription* table : tables) {
    if (!reader.has(*table)) {
      continue;
    }
    wrong = wrong_in(*table, reader, next, passes.size(), sampled);
    if (wrong) {
      return wrong;
    }
  }
  return std::nullopt;
}

/// The tables without those of each tick that the structure of the file does not name: a chunk of
/// another table may look like one of theirs, and then no tick would have all of its rows.
TableList without_unknown(const SessionReader& reader, TableList tables) {
  std::erase_if(tables, [&](const TableDescription* table) {
    return table->of() == RowsOf::kEachTick && !reader.has(*table);
  });
  return tables;
}

/// Reads the structure for this; without one that can be read, all tables stay.
TableList without_unknown(const fs::path& partial, const TableList& tables) {
  try {
    return without_unknown(SessionReader(partial), tables);
  } catch (const InputError&) {
    return tables;
  }
}

}  // namespace

std::optional<std::string> what_is_wrong(const fs::path& partial, const TableList& tables,
                                         const TableList& needed) {
  const std::vector<std::uint8_t> bytes = contents_of(partial);
  try {
    const SessionReader reader(partial);
    if (reader.version() != kSchemaVersion) {
      return fmt::format("it is of schema version {}", reader.version());
    }
    const RecoveredRows rows = rows_in(partial, bytes, without_unknown(reader, tables));
    for (const TableState& table : reader.tables()) {
      if (!table.fault.empty()) {
        return fmt::format("/{}: {}", table.name, table.fault);
      }
      const std::uint64_t held = rows.counts.contains(table.name) ? rows.counts.at(table.name) : 0;
      if (held > table.rows) {
        return fmt::format("it holds {} rows of /{}, but its structure points to {}", held,
                           table.name, table.rows);
      }
    }
    for (const TableDescription* table : needed) {
      if (table->of() != RowsOf::kEachTick && !reader.has(*table)) {
        return fmt::format("it has no /{}", table->name());
      }
    }
    return wrong_between_rows(reader, tables);
  } catch (const InputError&) {
    return "its structure cannot be read";
  }
}

Repair repair_session(const fs::path& partial, const std::string& wrong, const TableList& tables,
                      const TableList& needed) {
  const std::vector<std::uint8_t> bytes = contents_of(partial);
  const RecoveredRows rows = rows_in(partial, bytes, without_unknown(partial, tables));
  const std::optional<SessionInfo> info = find_info(partial, rows);
  if (!info) {
    throw InputError(partial.string() + ": " + wrong +
                     ", and the description of the session is lost; save what the file still holds "
                     "with haptrial recover");
  }
  const Plan plan(rows);
  const fs::path out = with(partial, ".repaired");
  for (const fs::path& left : {out, partial_path(out), new_path(out)}) {
    fs::remove(left);  // of a repair that was cut short
  }
  const fs::path damaged = name_for_damaged(partial);
  Repair repair;
  repair.dropped_passes = plan.dropped_passes();
  SessionWriter writer(out, *info, with_tables(rows.tables(), needed));
  write_repaired(std::move(writer), rows, plan, [&](const Written& written) {
    repair.dropped_rows = rows.counts.at(samples_table().schema().name) - written.samples;
    repair.told = fmt::format(
        "{} was damaged ({}); kept: {} samples ({} missing between them), {} passes ({} "
        "incomplete, which count as damaged or open), {} events, {} rows of /samples dropped; the "
        "original is kept as {}",
        partial.filename().string(), wrong, written.samples, written.missing, rows.passes.size(),
        plan.dropped_passes(), rows.events.size(), repair.dropped_rows,
        damaged.filename().string());
    return repair.told;
  });
  try {
    keep_damaged(partial, damaged);
    fs::rename(out, partial);
    sync_folder_of(partial);
  } catch (const std::exception& error) {
    throw RunError(partial.string() + ": cannot be repaired (" + sentence_of(error) + ")");
  }
  return repair;
}

}  // namespace haptrial::record
