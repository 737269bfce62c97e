#include "experiments/studio/session_files.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <string_view>
#include <system_error>

namespace haptrial::experiments {
namespace {

namespace fs = std::filesystem;

std::int64_t milliseconds_of(fs::file_time_type time) {
  const auto since = std::chrono::file_clock::to_sys(time).time_since_epoch();
  return std::chrono::duration_cast<std::chrono::milliseconds>(since).count();
}

/// When a session last went to the folder of excluded participants or came back [ms]; 0: never.
std::int64_t last_exclusion(const fs::path& folder) {
  std::error_code error;
  const auto changed = fs::last_write_time(folder / "excluded", error);
  return error ? 0 : milliseconds_of(changed);
}

}  // namespace

const FolderFile* SessionFolder::newest_session() const {
  const auto found = std::ranges::max_element(sessions, {}, &FolderFile::modified);
  return found == sessions.end() ? nullptr : &*found;
}

std::optional<std::string> media_type(const std::string& name) {
  constexpr std::array<std::pair<std::string_view, const char*>, 9> kTypes{{
      {".html", "text/html; charset=utf-8"},
      {".svg", "image/svg+xml"},
      {".png", "image/png"},
      {".jpg", "image/jpeg"},
      {".pdf", "application/pdf"},
      {".csv", "text/csv; charset=utf-8"},
      {".json", "application/json"},
      {".md", "text/plain; charset=utf-8"},
      {".txt", "text/plain; charset=utf-8"},
  }};
  const std::string ending = fs::path(name).extension().string();
  const auto found = std::ranges::find(kTypes, std::string_view(ending),
                                       &std::pair<std::string_view, const char*>::first);
  return found == kTypes.end() ? std::nullopt : std::optional<std::string>(found->second);
}

SessionFolder list_sessions(const fs::path& folder) {
  SessionFolder out;
  std::error_code error;
  std::int64_t report = 0;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    std::error_code gone;
    const FolderFile file{entry.path().filename().string(), entry.file_size(gone),
                          milliseconds_of(entry.last_write_time(gone))};
    if (gone || !entry.is_regular_file(gone) || file.name.starts_with('.')) {
      continue;
    }
    if (entry.path().extension() == ".h5") {
      out.sessions.push_back(file);
    } else if (media_type(file.name)) {
      out.results.push_back(file);
    }
    report = file.name == "report.html" ? file.modified : report;
  }
  std::ranges::sort(out.sessions, {}, &FolderFile::name);
  std::ranges::sort(out.results, {}, &FolderFile::name);
  const FolderFile* newest = out.newest_session();
  out.report = report > 0;
  out.report_is_old = out.report && std::max(newest != nullptr ? newest->modified : 0,
                                             last_exclusion(folder)) > report;
  return out;
}

}  // namespace haptrial::experiments
