#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "core/record/table/table_description.h"

namespace haptrial::record {

/// Why a session file cannot be gone on with as it stands, in words; nothing where it can. A file
/// is whole when its structure leads to every row that it holds, and the rows agree: after a power
/// cut, HDF5's structure may be older than the rows, or lead to older ones.
/// @param needed  tables that it must have, but those with a row for each tick
std::optional<std::string> what_is_wrong(const std::filesystem::path& partial,
                                         const TableList& tables, const TableList& needed = {});

/// Rows and chunks that a repair kept.
struct Repair {
  std::string told;                 // a sentence: what was wrong, what was kept
  std::uint64_t dropped_rows{0};    // of /samples, that nothing could go on behind
  std::uint64_t dropped_passes{0};  // rows of /trials without all of their samples: open again
};

/// Writes every row that the file still holds to a new file, and gives that one the name of the
/// old, which is kept as FILE.partial.damaged. Killed at any instant it leaves the old or the new
/// file under the name. A completed pass in between that lacks samples becomes a damaged one. In a
/// session with a table that has a row for each tick, nothing is kept after the first missing tick
/// of the pass that was under way, because its state is made again from ticks without a gap.
/// @param partial  locked by the caller
/// @param needed  tables that the new file has even if no row of them was found
/// @throws InputError when it does not say what the session was; it is left as it was.
Repair repair_session(const std::filesystem::path& partial, const std::string& wrong,
                      const TableList& tables, const TableList& needed);

}  // namespace haptrial::record
