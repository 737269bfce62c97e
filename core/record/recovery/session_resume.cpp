#include "core/record/recovery/session_resume.h"

#include <algorithm>
#include <iterator>

#include "core/base/error.h"
#include "core/record/hdf5/session_target.h"
#include "core/record/hdf5/session_writer_impl.h"
#include "core/record/read/session_facts.h"
#include "core/record/read/session_reader.h"
#include "core/record/read/tick_rows.h"
#include "core/record/recovery/repair.h"
#include "core/record/recovery/rewrite.h"

namespace haptrial::record {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const fs::path& partial, const std::string& found) {
  throw InputError(partial.string() + ": " + found +
                   "; choose an unfinished session, or save what a damaged file still holds with "
                   "haptrial recover");
}

/// The passes that the samples name and /trials does not, each from its first to its last sample.
void walk_samples(const SessionReader& reader, Resumed& found) {
  const auto in_trials = static_cast<std::int32_t>(found.passes.size());
  each_sample(reader, [&](const Sample& sample) {
    found.next_sequence = sample.sequence + 1;
    found.last_time_ns = sample.time_ns;
    if (sample.pass < in_trials) {
      return;
    }
    if (found.open_passes.empty() || found.open_passes.back().row != sample.pass) {
      found.open_passes.push_back({sample.pass, sample.sequence, sample.sequence});
    }
    found.open_passes.back().last_sample = sample.sequence;
  });
}

void sum_up_runs(const SessionReader& reader, Resumed& found) {
  found.runs = reader.runs();
  for (std::size_t i = 0; i < found.runs.size(); ++i) {
    const bool last = i + 1 == found.runs.size() || found.runs[i + 1].run != found.runs[i].run;
    if (!last) {
      continue;
    }
    found.earlier.overruns += found.runs[i].counts.overruns;
    found.earlier.dropped += found.runs[i].counts.dropped;
  }
  found.earlier.ticks = found.next_sequence;
  if (!found.runs.empty() && found.runs.back().state != RunState::kRunning) {
    const RunRow& last = found.runs.back();
    found.earlier.ticks = std::max(found.earlier.ticks, last.first_sample + last.counts.ticks);
  }
  found.ended = !found.runs.empty() && found.runs.back().state == RunState::kEnded;
}

/// State from which an undamaged file goes on.
Resumed examine(const SessionReader& reader) {
  Resumed found;
  found.info = reader.info();
  found.rows = reader.sample_count();
  found.passes = reader.passes();
  found.begun = reader.begun();
  walk_samples(reader, found);
  found.events = reader.events();
  found.skipped = skipped_trials(reader);
  found.taken_back = reader.rows<TakenBackRow>();
  if (reader.has(responses_table())) {
    found.responses = reader.responses();
  }
  if (reader.has(table_of<AnswerRow>())) {
    found.answers = reader.rows<AnswerRow>();
  }
  for (const StimulusRow& row : reader.stimuli()) {
    if (found.blocks.empty() || found.blocks.back() != row.block) {
      found.blocks.push_back(row.block);
    }
  }
  sum_up_runs(reader, found);
  return found;
}

}  // namespace

Unfinished read_unfinished(const fs::path& partial) {
  try {
    const SessionReader reader(partial);
    return {reader.info(), reader.events()};
  } catch (const InputError&) {
    const std::vector<std::uint8_t> bytes = contents_of(partial);
    const RecoveredRows rows = rows_in(partial, bytes, {});
    const auto info = find_info(partial, rows);
    if (!info) {
      throw;
    }
    return {*info, rows.events};
  }
}

bool SessionWriter::can_resume(const fs::path& final_path) {
  std::error_code ignored;
  if (fs::exists(final_path, ignored)) {
    throw InputError(final_path.string() +
                     ": the session is complete; only an unfinished session can be resumed");
  }
  return fs::exists(partial_path(final_path), ignored);
}

SessionWriter SessionWriter::resume(const fs::path& final_path, Resumed& found,
                                    const TableList& tables, const TableList& needed) {
  const fs::path partial = partial_path(final_path);
  if (!can_resume(final_path)) {
    throw InputError(
        partial.string() +
        ": no such file, so there is no unfinished session to resume; leave out --resume");
  }
  FileLock lock = FileLock::take(partial, false);
  Repair repair;
  if (const auto wrong = what_is_wrong(partial, tables, needed)) {
    repair = repair_session(partial, *wrong, tables, needed);
    lock = FileLock::take(partial, false);
  }
  TableList own;
  {
    const SessionReader reader(partial);
    found = examine(reader);
    std::copy_if(tables.begin(), tables.end(), std::back_inserter(own),
                 [&](const TableDescription* table) { return reader.has(*table); });
  }
  found.repaired = repair.told;
  found.dropped_rows = repair.dropped_rows;
  found.dropped_passes = repair.dropped_passes;
  try {
    auto impl = std::make_unique<Impl>(final_path, found.info, std::move(lock), own);
    impl->take_up(found);
    return SessionWriter(std::move(impl));
  } catch (const h5::InUseError&) {
    throw InputError(partial.string() +
                     ": another program has the file open, such as a viewer or a script that "
                     "reads it; close the file there, then resume again");
  } catch (const h5::Error& error) {
    refuse(partial, std::string("cannot be written (") + error.what() + ")");
  }
}

/// The counts of a session that had ended may not have reached the file.
void SessionWriter::Impl::take_up(const Resumed& found) {
  earlier = found.earlier;
  if (!found.runs.empty()) {
    run_row = found.runs.back();
  }
  run.run = found.runs.empty() ? 1 : run_row->run + 1;
  run.first_sample = found.next_sequence;
  has_timing = found.ended;
  if (found.ended && h5::get_i64(timing->dataset(), "ticks") < 0) {
    put_counts();
  }
}

}  // namespace haptrial::record
