#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/record/read/session_reader.h"
#include "core/record/rows/common_tables.h"

namespace haptrial::record {

/// Whether a session file holds every tick, and its passes agree with its samples.
struct Integrity {
  std::uint64_t rows{0};            // of /samples
  std::uint64_t gaps{0};            // rows whose sequence number does not follow the one before
  std::uint64_t first_sequence{0};  // 0 when there are no rows, as is the next
  std::uint64_t last_sequence{0};
  std::uint64_t passes{0};
  std::uint64_t aborted{0};   // passes among them; no problem in itself
  std::uint64_t damaged{0};   // passes among them that a repair found without all of their samples
  std::uint64_t practice{0};  // passes among them
  std::uint64_t overruns{0};  // late ticks; no problem in itself
  std::uint64_t dropped{0};
  RunState state{RunState::kRunning};  // how the last run stands
  bool ok{true};
  std::vector<std::string> problems;  // a sentence each, without the file's name
};

/// Reads the whole file, a piece at a time.
/// @param tables  beside those of every session, some of which the file may have
/// @throws InputError when it is damaged below the level that this can describe.
Integrity check_session(const SessionReader& reader, const TableList& tables = common_tables());

}  // namespace haptrial::record
