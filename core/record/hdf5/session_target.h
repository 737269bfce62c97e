#pragma once

#include <filesystem>

/// The names that a session file has on its way, and the steps between them:
///
///     FILE.partial.new   while it is created: cannot hold a sample
///     FILE.partial       from the moment on in which it can take samples
///     FILE               complete
namespace haptrial::record {

std::filesystem::path partial_path(const std::filesystem::path& final_path);
std::filesystem::path new_path(const std::filesystem::path& final_path);

/// The folder that a file is in.
std::filesystem::path folder_of(const std::filesystem::path& file);

/// @throws InputError unless FILE can be created: neither it nor FILE.partial exists, and its
/// folder may be written.
void check_target(const std::filesystem::path& final_path);

/// Renames without overwriting. @throws h5::Error in the words of the system.
void give_name(const std::filesystem::path& from, const std::filesystem::path& to);

/// Brings a file or the folder of a file to the disk. @throws h5::Error in the words of the system.
void sync_data(int descriptor);
void sync_file(const std::filesystem::path& file);
void sync_folder_of(const std::filesystem::path& file);

/// Gives back the blocks that were reserved behind the end. Best effort: they hold nothing.
void trim(const std::filesystem::path& path) noexcept;

}  // namespace haptrial::record
