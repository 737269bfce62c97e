#pragma once

#include <filesystem>
#include <string>

namespace haptrial::experiments {

/// Copies the file of an ended session into FOLDER/STUDY: under the name FILE.copying, which an
/// interrupted copy may have left, then synced, compared byte by byte with the session and renamed.
/// The session's file is only read, and another file of its name is never replaced.
/// @param folder  must be there, since the mount point of a disk that is unplugged is not made
/// @returns the copy, which may have been there before
/// @throws RunError that says what failed
std::filesystem::path back_up(const std::filesystem::path& session,
                              const std::filesystem::path& folder, const std::string& study);

/// How a backup went.
struct BackupResult {
  bool kept{false};      // there is a copy
  std::string sentence;  // where the copy is; else in capitals that there is none, and what to do
};

/// back_up() for the end of a session, which is done whatever comes of its backup.
BackupResult try_back_up(const std::filesystem::path& session, const std::filesystem::path& folder,
                         const std::string& study);

}  // namespace haptrial::experiments
