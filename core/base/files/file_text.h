#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace haptrial {

/// All bytes of a file. @throws InputError where it cannot be read.
std::string file_text(const std::filesystem::path& file);

/// Writes a small file anew; one that was there is replaced (core/base/files/whole_file.h for a
/// file that must never be half-written).
/// @param told  what a message calls the file, when it is not `file`
/// @throws RunError in the words of the system, as on a full disk.
void write_text(const std::filesystem::path& file, std::string_view text,
                const std::filesystem::path& told = {});
/// Adds to the end of a file, which is made where it is not there. Otherwise as write_text().
void append_text(const std::filesystem::path& file, std::string_view text,
                 const std::filesystem::path& told = {});

}  // namespace haptrial
