#pragma once

#include <filesystem>
#include <optional>

#include "core/record/rows/session_types.h"

namespace haptrial::record {

/// The root attributes of a file that may be damaged, read by a process of its own: HDF5 1.10 can
/// crash, or not come back, on a damaged heap of texts. Nothing where it does or finds none.
/// For a program with one thread.
std::optional<SessionInfo> isolated_info(const std::filesystem::path& file);

}  // namespace haptrial::record
