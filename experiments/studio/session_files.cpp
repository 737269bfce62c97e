#include "experiments/studio/session_files.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <regex>
#include <sstream>
#include <string_view>
#include <system_error>

#include "core/base/error.h"
#include "experiments/studio/study_folder.h"

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

/// When a file came to its place or was written, whichever is later: a copy that keeps the time of
/// its original is new here all the same [ms].
std::int64_t arrival_of(const fs::path& file, std::int64_t modified) {
  struct stat entry {};
  if (::stat(file.c_str(), &entry) != 0) {
    return modified;
  }
  return std::max<std::int64_t>(
      modified, 1000 * std::int64_t{entry.st_ctim.tv_sec} + entry.st_ctim.tv_nsec / 1'000'000);
}

}  // namespace

const FolderFile* SessionFolder::newest_session() const {
  const FolderFile* newest = nullptr;
  for (const std::vector<FolderFile>* files : {&sessions, &unfinished}) {
    for (const FolderFile& file : *files) {
      newest = newest == nullptr || file.modified > newest->modified ? &file : newest;
    }
  }
  return newest;
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
  std::int64_t report = 0, last_arrival = last_exclusion(folder);
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    std::error_code gone;
    const FolderFile file{entry.path().filename().string(), entry.file_size(gone),
                          milliseconds_of(entry.last_write_time(gone))};
    if (gone || !entry.is_regular_file(gone) || file.name.starts_with('.')) {
      continue;
    }
    if (entry.path().extension() == ".h5") {
      out.sessions.push_back(file);
      last_arrival = std::max(last_arrival, arrival_of(entry.path(), file.modified));
    } else if (file.name.ends_with(".h5.partial")) {
      out.unfinished.push_back(file);
    } else if (media_type(file.name)) {
      out.results.push_back(file);
    }
    report = file.name == "report.html" ? file.modified : report;
  }
  std::ranges::sort(out.sessions, {}, &FolderFile::name);
  std::ranges::sort(out.unfinished, {}, &FolderFile::name);
  std::ranges::sort(out.results, {}, &FolderFile::name);
  out.report = report > 0;
  out.report_is_old = out.report && last_arrival > report;
  return out;
}

namespace {

/// @param pattern  of the values that are allowed  @param allowed  the same in words
void add_value(CommandWords& words, const char* option, const std::string& value,
               const char* pattern, const char* allowed) {
  if (value.empty()) {
    return;
  }
  if (!std::regex_match(value, std::regex(pattern))) {
    throw InputError(fmt::format("{} is not what it can be; allowed: {}", option + 2, allowed));
  }
  words.insert(words.end(), {option, value});
}

std::string first_match(const std::string& output, const std::regex& line) {
  std::istringstream lines(output);
  for (std::string each; std::getline(lines, each);) {
    if (std::smatch parts; std::regex_match(each, parts, line)) {
      return parts.str(1);
    }
  }
  return "";
}

}  // namespace

CommandWords session_words(const std::string& command, const SessionChoice& choice) {
  constexpr const char* kPlain = "up to 64 letters A to Z, digits, '_' and '-'";
  constexpr const char* kPlainPattern = "[A-Za-z0-9_][A-Za-z0-9_-]{0,63}";
  CommandWords words{command, choice.file};
  add_value(words, "--subject", choice.subject, kPlainPattern, kPlain);
  if (choice.session > 0) {
    words.insert(words.end(), {"--session", std::to_string(choice.session)});
  }
  for (const std::string& device : choice.devices) {
    add_value(words, "--device", device, kPlainPattern, kPlain);
  }
  add_value(words, "--language", choice.language, kPlainPattern, kPlain);
  add_value(words, "--handedness", choice.handedness, "left|right|both", "left, right, both");
  add_value(words, "--consent", choice.consent, "[A-Za-z0-9][A-Za-z0-9 .:_-]{0,63}",
            "up to 64 letters A to Z, digits, spaces, '.', ':', '_' and '-', such as a date");
  add_value(words, "--watch", choice.watch, "[0-9A-Fa-f][0-9A-Fa-f.:]{1,44}",
            "the numeric address of a network interface of this computer");
  for (const auto& [option, given] :
       {std::pair{"--window", choice.window}, std::pair{"--resume", choice.resume},
        std::pair{"--pilot", choice.pilot}}) {
    if (given) {
      words.emplace_back(option);
    }
  }
  words.insert(words.end(), {"--console", "--out", StudyFolder::sessions_of(choice.file)});
  return words;
}

SessionAddresses addresses_in(const std::string& output) {
  static const std::regex kConsole(R"(console: (http://127\.0\.0\.1:[0-9]+/\?token=[0-9a-f]{32}))");
  static const std::regex kWatch(
      R"(watch: (http://(?:[0-9.]+|\[[0-9a-f:]+\]):[0-9]+/\?token=[0-9a-f]{32}))");
  return {first_match(output, kConsole), first_match(output, kWatch)};
}

}  // namespace haptrial::experiments
