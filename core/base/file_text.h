#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace haptrial {

/// Refuses a folder, and a pipe or device from which reading might never end. What opens a file
/// that a user names calls this first (OpenedFilesTest). A missing file is left to the reader.
/// @throws InputError
void refuse_special_file(const std::filesystem::path& file);

/// All bytes of a file. @throws InputError if it cannot be read or is not a regular file.
std::string file_text(const std::filesystem::path& file);
/// The first bytes of a file; fewer than `most` if it has no more. @throws as file_text() does
std::string file_head(const std::filesystem::path& file, std::size_t most);

/// Writes a small file anew; one that was there is replaced (core/base/whole_file.h for a
/// file that must never be half-written).
/// @param told  what a message calls the file, when it is not `file`
/// @throws RunError in the words of the system, as on a full disk.
void write_text(const std::filesystem::path& file, std::string_view text,
                const std::filesystem::path& told = {});
/// Adds to the end of a file, which is made where it is not there. Otherwise as write_text().
void append_text(const std::filesystem::path& file, std::string_view text,
                 const std::filesystem::path& told = {});

}  // namespace haptrial
