#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "core/record/hdf5/session_writer.h"
#include "core/record/recovery/recovered_rows.h"
#include "core/record/rows/session_types.h"

namespace haptrial::record {

/// The contents of a file. @throws InputError when it is not a regular file or cannot be read.
std::vector<std::uint8_t> contents_of(const std::filesystem::path& file);

/// Every row that the contents of a file hold. @throws InputError for an unknown word among them
RecoveredRows rows_in(const std::filesystem::path& file, std::span<const std::uint8_t> contents,
                      const TableList& tables);

/// Session's facts from /attributes; from the root attributes if that is lost, or in a file of
/// version 1.
std::optional<SessionInfo> find_info(const std::filesystem::path& file, const RecoveredRows& rows);

/// Writes the rows but those of /trials, of tables whose rows belong to passes, and the counts of
/// the loop.
/// @param keeps  of a tick: whether its rows are written
/// @param told   every piece of samples that was written
void write_rows(SessionWriter& writer, const RecoveredRows& rows,
                const std::function<bool(std::uint64_t sequence)>& keeps,
                const std::function<void(std::span<const Sample>)>& told);

/// Writes the rows that belong to passes. @param passes  rows of /trials that there are
/// @param begun  passes that rows of RowsOf::kPass may number
void write_rows_of_passes(SessionWriter& writer, const RecoveredRows& rows, std::size_t passes,
                          std::size_t begun);

/// The root attributes of a file that may be damaged, read by a process of its own: HDF5 1.10 can
/// crash, or not come back, on a damaged heap of texts. Nothing where it does or finds none.
/// For a program with one thread.
std::optional<SessionInfo> isolated_info(const std::filesystem::path& file);

}  // namespace haptrial::record
