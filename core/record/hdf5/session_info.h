#pragma once

#include <optional>
#include <vector>

#include "core/record/hdf5/hdf5_layer.h"
#include "core/record/rows/session_types.h"

namespace haptrial::record {

/// @returns the name of the first text of `info` that holds a NUL byte; else nothing.
std::optional<std::string> text_with_nul(const SessionInfo& info);

/// SessionInfo as root attributes. @throws h5::Error
void put_info(const h5::Id& file, const SessionInfo& info);
/// @throws h5::Error also for a schema version that is not read.
std::int64_t get_version(const h5::Id& file);
/// Session's facts from the root attributes. HDF5 1.10 can crash on a damaged heap of texts, so
/// that a reader prefers /attributes where a file has them. @throws h5::Error
SessionInfo get_info(const h5::Id& file);

/// The same as rows of /attributes: kind is the name, text the value; `time_ns` is unused.
std::vector<EventRow> info_rows(const SessionInfo& info);
/// Session's facts from its rows; fields that none names stay as they are by default.
SessionInfo info_of(const std::vector<EventRow>& rows);

}  // namespace haptrial::record
