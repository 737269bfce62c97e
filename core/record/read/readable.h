#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace haptrial::record {

/// Reads a session file as any program with HDF5 does: every attribute, and every row through
/// HDF5's own filters; and compares what is in it twice. A process of its own does it, because
/// HDF5 1.10 can crash, or not come back, on a damaged heap of texts. For a program with one
/// thread.
/// @returns a sentence about the first thing that cannot be read or does not agree; else nothing
std::optional<std::string> what_cannot_be_read(const std::filesystem::path& file);

}  // namespace haptrial::record
