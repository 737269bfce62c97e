#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/record/rows/answer_rows.h"
#include "core/record/rows/session_types.h"
#include "core/record/rows/trial_facts.h"

namespace haptrial::record {

/// Samples of a pass that has no row in /trials: it was under way when the session ended.
struct OpenPass {
  std::int32_t row{0};            // that its samples name
  std::uint64_t first_sample{0};  // sequence numbers, both inclusive
  std::uint64_t last_sample{0};
};

/// Contents of a session file when writing it went on. The session first adds a row for each open
/// pass (status aborted), and goes on with next_sequence and the time after last_time_ns.
struct Resumed {
  SessionInfo info;
  std::vector<EventRow> events;
  std::vector<PassRow> passes;        // with all of their samples
  std::vector<OpenPass> open_passes;  // in order; their rows follow those of `passes`
  std::vector<ResponseRow> responses;
  std::vector<SkippedRow> skipped;
  std::vector<TakenBackRow> taken_back;
  std::vector<AnswerRow> answers;    // to pages
  std::vector<std::int32_t> blocks;  // whose stimuli are there
  std::uint64_t rows{0};             // of /samples
  std::uint64_t next_sequence{0};    // of the first sample to append
  std::int64_t last_time_ns{-1};     // of the last sample; -1 where there is none
  std::vector<BegunRow> begun;       // what was known of each pass when it began
  std::vector<RunRow> runs;
  TimingSummary earlier;            // of all runs; a run that was killed counts what it told
  std::string repaired;             // what was wrong and what was kept; empty: it was whole
  std::uint64_t dropped_rows{0};    // of /samples, in a repair
  std::uint64_t dropped_passes{0};  // rows of /trials whose samples were not all there
  bool ended{false};                // the counts are there: only close() is left to do
};

/// Facts of an unfinished session that are asked for before it is gone on with.
struct Unfinished {
  SessionInfo info;
  std::vector<EventRow> events;
};

/// Reads them and changes nothing. Where the structure of the file is damaged, they are of the rows
/// that it still holds, as after the repair by SessionWriter::resume().
/// For a program with one thread.
/// @throws InputError when the file does not say what the session was
Unfinished read_unfinished(const std::filesystem::path& partial);

}  // namespace haptrial::record
