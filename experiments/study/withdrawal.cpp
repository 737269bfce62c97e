#include "experiments/study/withdrawal.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <pwd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <chrono>
#include <set>
#include <sstream>

#include "core/base/error.h"
#include "core/base/file_text.h"
#include "core/base/whole_file.h"
#include "core/record/hdf5/file_lock.h"
#include "core/record/read/session_reader.h"

namespace haptrial::experiments {
namespace {

namespace fs = std::filesystem;

constexpr const char* kList = "withdrawals.csv";

bool is_session_file(const fs::path& file) {
  constexpr std::array kEndings{".h5", ".h5.partial", ".h5.copying"};
  const std::string name = file.filename().string();
  return std::ranges::any_of(kEndings, [&](const char* ending) { return name.ends_with(ending); });
}

/// Kinds of files that only commands write into folders of sessions.
bool is_made(const fs::path& file) {
  static const std::set<std::string> kKinds{".html", ".csv", ".tsv",  ".json", ".svg", ".pdf",
                                            ".png",  ".mp4", ".webm", ".xdf",  ".md",  ".gz"};
  return kKinds.contains(file.extension().string()) && file.filename() != kList &&
         !(file.filename() == "reasons.csv" && file.parent_path().filename() == "excluded");
}

bool is_of(const fs::path& file, const std::string& subject) {
  try {
    return record::SessionReader(file).info().subject == subject;
  } catch (const std::exception&) {
    return has_word(file.filename().string(), subject);  // unreadable: its name tells
  }
}

void sort_in(const fs::path& file, const std::string& subject, Withdrawal& found) {
  if (is_session_file(file)) {
    if (is_of(file, subject)) {
      if (file.extension() == ".partial" && record::FileLock::taken(file)) {
        throw InputError(fmt::format("{}: a session of {} is being recorded; end it first",
                                     file.string(), subject));
      }
      found.sessions.push_back(file);
    }
  } else if (is_made(file)) {
    found.made.push_back(file);
  } else if (file.filename() != "reasons.csv" &&
             (has_word(file.filename().string(), subject) || has_word(file_text(file), subject))) {
    found.others.push_back(file);
  }
}

void remove_reason(const fs::path& file, const std::string& subject) {
  if (!fs::exists(file)) {
    return;
  }
  std::istringstream lines(file_text(file));
  std::string kept;
  bool rows = false;
  for (std::string line; std::getline(lines, line);) {
    if (!has_word(line.substr(0, line.find(',')), subject)) {
      rows = rows || !kept.empty();
      kept += line + "\n";
    }
  }
  rows ? write_whole(file, kept) : static_cast<void>(fs::remove(file));
}

/// Folders below a folder without anything in them.
void remove_empty(const fs::path& folder) {
  std::vector<fs::path> below;
  for (const auto& each : fs::recursive_directory_iterator(folder)) {
    if (each.is_directory() && !each.is_symlink()) {
      below.push_back(each.path());
    }
  }
  for (auto each = below.rbegin(); each != below.rend(); ++each) {
    std::error_code ignored;
    if (fs::is_empty(*each, ignored)) {
      fs::remove(*each, ignored);
    }
  }
}

std::string login() {
  const passwd* entry = ::getpwuid(::getuid());
  return entry != nullptr ? entry->pw_name : std::to_string(::getuid());
}

}  // namespace

bool has_word(std::string_view text, std::string_view word) {
  const auto joins = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; };
  for (auto at = text.find(word); at != std::string_view::npos; at = text.find(word, at + 1)) {
    const std::size_t end = at + word.size();
    if ((at == 0 || !joins(text[at - 1])) && (end == text.size() || !joins(text[end]))) {
      return true;
    }
  }
  return false;
}

Withdrawal find_withdrawal(const std::vector<fs::path>& folders, const std::string& subject) {
  Withdrawal found;
  for (const fs::path& folder : folders) {
    if (!fs::is_directory(folder)) {
      throw InputError(fmt::format("{}: not a folder", folder.string()));
    }
    for (const auto& each : fs::recursive_directory_iterator(folder)) {
      if (each.is_regular_file() && !each.is_symlink()) {
        sort_in(each.path(), subject, found);
      }
    }
  }
  for (auto* list : {&found.sessions, &found.made, &found.others}) {
    std::ranges::sort(*list);
    list->erase(std::unique(list->begin(), list->end()), list->end());
  }
  if (found.sessions.empty()) {
    throw InputError(
        fmt::format("{} has no session file in {}", subject, folders.front().string()));
  }
  return found;
}

void withdraw(const Withdrawal& found, const std::vector<fs::path>& folders,
              const std::string& subject) {
  for (const auto* list : {&found.sessions, &found.made}) {
    for (const fs::path& file : *list) {
      std::error_code error;
      if (!fs::remove(file, error)) {
        throw RunError(fmt::format("{}: could not be deleted: {}", file.string(), error.message()));
      }
    }
  }
  for (const fs::path& folder : folders) {
    remove_reason(folder / "excluded" / "reasons.csv", subject);
    remove_empty(folder);
  }
  const fs::path list = folders.front() / kList;
  const auto now =
      std::chrono::time_point_cast<std::chrono::seconds>(std::chrono::system_clock::now());
  append_text(list, fmt::format("{}{:%FT%TZ},{},{},{}\n",
                                fs::exists(list) ? "" : "time,login,sessions,made_from_sessions\n",
                                now, login(), found.sessions.size(), found.made.size()));
}

}  // namespace haptrial::experiments
