#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace haptrial::experiments {

/// A file of a folder of sessions.
struct FolderFile {
  std::string name;
  std::uintmax_t bytes{0};
  std::int64_t modified{0};  // since 1970 [ms]
};

/// The files of a folder of sessions; none, if it is not there.
struct SessionFolder {
  std::vector<FolderFile> sessions;  // by name
  std::vector<FolderFile> results;   // reports, figures and tables, by name
  bool report{false};                // report.html is there
  bool report_is_old{false};         // a session or an exclusion is newer than it

  /// Null without sessions.
  const FolderFile* newest_session() const;
};

SessionFolder list_sessions(const std::filesystem::path& folder);

/// The media type of a file that the studio serves; nothing for others.
std::optional<std::string> media_type(const std::string& name);

}  // namespace haptrial::experiments
