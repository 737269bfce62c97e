#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "core/record/rows/common_tables.h"
#include "core/record/rows/session_types.h"
#include "core/record/table/table.h"

namespace haptrial::record {

/// Result of recover_session().
struct Recovery {
  std::uint64_t file_bytes{0};
  std::uint64_t samples{0};
  std::uint64_t first_sequence{0};  // 0 when there are no samples, as is the next
  std::uint64_t last_sequence{0};
  std::uint64_t missing{0};  // sequence numbers between them that are not there
  std::uint64_t passes{0};
  std::uint64_t passes_cut{0};  // whose samples are not all there
  std::uint64_t events{0};
  std::uint64_t stimulus_blocks{0};
  std::uint64_t frames{0};
  bool info{false};   // definition, subject, device, ... are known
  bool ended{false};  // the loop's own counts are there
  std::string subject;

  /// Whether there is anything that a session recorded.
  bool anything() const { return samples + passes + events + stimulus_blocks + frames > 0; }
};

/// Writes whatever the damaged session file still holds to the new session file `out`; nothing when
/// there is nothing. The structure of the file is not needed: every chunk of rows that is whole is
/// found by itself (core/record/recovery/recovered_rows.h), and the older copies of a chunk that
/// was written again stand in for a damaged one. Where samples are missing the sequence numbers
/// have a gap; an event "recovered" says how the file came to be.
/// @param tables  beside those of every session, some of which the file may have
/// @param more    further tables that a session's definition states, as its channels; they outlive
/// the call
/// @throws InputError when `file` is absent, not a regular file, or being written by another
/// process, or `out` exists; RunError when `out` cannot be written.
Recovery recover_session(const std::filesystem::path& file, const std::filesystem::path& out,
                         const TableList& tables = common_tables(),
                         const std::function<TableList(const SessionInfo&)>& more = {});

}  // namespace haptrial::record
