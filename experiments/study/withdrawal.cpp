#include "experiments/study/withdrawal.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <functional>
#include <iterator>
#include <map>
#include <optional>
#include <ranges>
#include <regex>
#include <set>
#include <sstream>

#include "analysis/files/sha256.h"
#include "core/base/error.h"
#include "core/base/file_text.h"
#include "core/base/whole_file.h"
#include "core/record/hdf5/file_lock.h"
#include "core/record/read/session_reader.h"
#include "experiments/plan/plan_log.h"
#include "protocols/interface/study_rules.h"

namespace haptrial::experiments {
namespace {

namespace fs = std::filesystem;

constexpr const char* kList = "withdrawals.csv";

/// Whether a file is a session's, or what recording, copying and repairing keep beside it.
bool is_session_file(const fs::path& file) {
  static const std::regex kName(R"(.*\.h5(\.(partial|new|copying|repaired|damaged(-[0-9]+)?))*)");
  return std::regex_match(file.filename().string(), kName);
}

/// A plan and its log, which name nobody and are never changed.
bool is_plan(const fs::path& file) {
  return file.filename().string().find(".plan.") != std::string::npos;
}

/// Tables beside sessions with a row for each of them that people filled in: what they said of
/// others stays.
bool is_filled_in(const fs::path& file) {
  static const std::set<std::string> kTables{"ratings.csv", "checklist.csv"};
  return kTables.contains(file.filename().string()) ||
         (file.filename() == "reasons.csv" && file.parent_path().filename() == "excluded");
}

/// Kinds of files that commands make from sessions.
bool is_made(const fs::path& file) {
  static const std::set<std::string> kKinds{".html", ".csv", ".tsv",  ".json", ".svg", ".pdf",
                                            ".png",  ".mp4", ".webm", ".xdf",  ".md",  ".gz"};
  return kKinds.contains(file.extension().string());
}

/// Nothing for a file that cannot be read.
std::optional<record::SessionInfo> info_of(const fs::path& file) {
  try {
    return record::SessionReader(file).info();
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

/// The identifier in the name of a session file: "P01-b" of "P01-b-session-2.h5.partial".
std::string identifier_in(const fs::path& file) {
  static const std::regex kName(R"((.*?)(-session-[0-9]+)?\.h5(\..*)?)");
  const std::string name = file.filename().string();
  std::smatch parts;
  return std::regex_match(name, parts, kName) ? parts[1].str() : name;
}

/// A participant in texts and names of files. Another's identifier may go on where this one ends:
/// "P01-b" names nobody called P01.
class NamedSubject {
 public:
  /// @param files  of whose sessions the other identifiers are known
  NamedSubject(std::string subject, const std::vector<fs::path>& files)
      : subject_(std::move(subject)) {
    for (const fs::path& file : files) {
      if (is_session_file(file)) {
        const auto info = info_of(file);
        const std::string other = info ? info->subject : identifier_in(file);
        const bool goes_on = info ? has_word(other, subject_) : other.starts_with(subject_ + "-");
        if (other != subject_ && goes_on) {
          longer_.insert(other);
        }
      }
    }
  }
  const std::string& identifier() const { return subject_; }
  bool is_in(std::string text) const {
    for (const std::string& other : longer_) {
      for (auto at = text.find(other); at != text.npos; at = text.find(other, at + 1)) {
        text.replace(at, other.size(), other.size(), '_');
      }
    }
    return has_word(text, subject_);
  }

 private:
  std::string subject_;
  std::set<std::string, std::greater<>> longer_;  // "P01-b-c" before "P01-b"
};

bool is_below(const fs::path& file, const fs::path& folder) {
  return std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first ==
         folder.end();
}

/// Each file once, also if folders lie within each other.
std::vector<fs::path> files_below(const std::vector<fs::path>& folders) {
  std::map<fs::path, fs::path> files;  // by canonical path
  for (const fs::path& folder : folders) {
    if (!fs::is_directory(folder)) {
      throw InputError(fmt::format("{}: not a folder", folder.string()));
    }
    for (const auto& each : fs::recursive_directory_iterator(folder)) {
      if (each.is_regular_file() && !each.is_symlink()) {
        files.emplace(fs::canonical(each.path()), each.path());
      }
    }
  }
  const auto names = std::views::values(files);
  return {names.begin(), names.end()};
}

/// The sessions of the study's own folder, by which those of other folders are judged: the same
/// identifier may be somebody else's in another study.
class OwnStudy {
 public:
  OwnStudy(const fs::path& folder, const ProtocolOf& protocol_of) : protocol_of_(protocol_of) {
    for (const fs::path& file : files_below({folder})) {
      if (const auto info = is_session_file(file) ? info_of(file) : std::nullopt) {
        by_definition_.emplace(info->definition, *info);
      }
    }
  }
  /// Without a session to compare with, every one is taken for the study's.
  bool has(const record::SessionInfo& session) const {
    return by_definition_.empty() || by_definition_.contains(session.definition) ||
           std::ranges::any_of(by_definition_,
                               [&](const auto& own) { return is_same(own.second, session); });
  }

 private:
  bool is_same(const record::SessionInfo& own, const record::SessionInfo& session) const {
    try {
      return protocols::study_changes(protocol_of_(own), own, session).same_study();
    } catch (const InputError&) {
      return false;  // a protocol that this program does not have
    }
  }

  const ProtocolOf& protocol_of_;
  std::map<std::string, record::SessionInfo> by_definition_;  // one session of each
};

/// Finds the participant's sessions; those of another study are among the others.
void find_sessions(const std::vector<fs::path>& files, const NamedSubject& subject,
                   const OwnStudy& study, Withdrawal& found) {
  for (const fs::path& file : files) {
    if (!is_session_file(file)) {
      continue;
    }
    const auto info = info_of(file);
    // The name of a file that cannot be read tells whose it is.
    const std::string whose = info ? info->subject : identifier_in(file);
    const bool own = whose == subject.identifier();
    if (own ? info && !study.has(*info) : !info && subject.is_in(whose)) {
      found.others.push_back(file);
    }
    if (!own || (info && !study.has(*info))) {
      continue;
    }
    if (file.extension() == ".partial" && record::FileLock::taken(file)) {
      throw InputError(fmt::format("{}: a session of {} is being recorded; end it first",
                                   file.string(), subject.identifier()));
    }
    found.sessions.push_back(file);
  }
}

/// Tables and recordings of an export that say when sessions began.
bool states_starts(const fs::path& file) {
  const std::string name = file.filename().string();
  return name == "sessions.csv" || name.ends_with("_scans.tsv") ||
         name.ends_with("_sessions.tsv") || name.ends_with(".xdf");
}

/// When the participant's sessions began, as a file of an export says: "2026-11-20T09:30:00Z".
std::set<std::string> stated_starts(const fs::path& file, const NamedSubject& subject) {
  constexpr std::size_t kLooked = 1'000'000;  // [bytes]
  static const std::regex kTime(R"(\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ)");
  const bool all = subject.is_in(file.string());
  std::set<std::string> starts;
  std::istringstream lines(file_head(file, kLooked));
  for (std::string line; std::getline(lines, line);) {
    if (all || subject.is_in(line)) {
      starts.insert(std::sregex_token_iterator(line.begin(), line.end(), kTime),
                    std::sregex_token_iterator());
    }
  }
  return starts;
}

/// The folder of an export that a file with starts belongs to: BIDS keeps a folder for each
/// participant and session.
fs::path export_folder(const fs::path& file) {
  fs::path folder = file.parent_path();
  const auto begins = [&](const char* with) {
    return folder.filename().string().starts_with(with);
  };
  while (begins("sub-") || begins("ses-")) {
    folder = folder.parent_path();
  }
  return folder;
}

/// Folders outside the study's own that were exported from another one: they say when sessions of
/// the participant began, but none of those that are withdrawn.
std::vector<fs::path> foreign_exports(const std::vector<fs::path>& files, const fs::path& study,
                                      const NamedSubject& subject,
                                      const std::vector<fs::path>& sessions) {
  std::set<std::string> own;
  for (const fs::path& session : sessions) {
    if (const auto info = info_of(session)) {
      own.insert(info->start_utc);
    }
  }
  std::map<fs::path, std::set<std::string>> stated;
  for (const fs::path& file : files) {
    if (states_starts(file) && !is_below(file, study)) {
      stated[export_folder(file)].merge(stated_starts(file, subject));
    }
  }
  std::vector<fs::path> foreign;
  for (const auto& [folder, starts] : stated) {
    const auto is_own = [&](const std::string& start) { return own.contains(start); };
    if (!own.empty() && !starts.empty() && std::ranges::none_of(starts, is_own)) {
      foreign.push_back(folder);
    }
  }
  return foreign;
}

/// Whether bytes of a file are words: in compressed ones an identifier occurs by chance.
bool has_text(const fs::path& file) {
  static const std::set<std::string> kCompressed{".gz", ".png", ".mp4", ".webm", ".pdf"};
  return !kCompressed.contains(file.extension().string());
}

/// Whether a text names a participant. A plain number stands in texts for other things, too.
bool text_names(const std::string& text, const NamedSubject& subject) {
  const bool number =
      std::ranges::all_of(subject.identifier(), [](char c) { return c >= '0' && c <= '9'; });
  return !number && subject.is_in(text);
}

/// Whether the way from one of the given folders to a file names a participant.
bool path_names(const fs::path& file, const std::vector<fs::path>& folders,
                const NamedSubject& subject) {
  const auto given =
      std::ranges::find_if(folders, [&](const fs::path& folder) { return is_below(file, folder); });
  const fs::path way = given == folders.end() ? file : file.lexically_relative(*given);
  return subject.is_in(way.string());
}

/// Participants of the session files that can be read, and files of other participants in whose
/// events or definition the participant is named, such as sessions that the participant led.
struct OtherSessions {
  std::set<std::string> participants;
  std::vector<fs::path> naming;
};

bool names_in(const record::SessionReader& reader, const NamedSubject& subject) {
  const auto events = reader.events();
  return text_names(reader.info().definition, subject) ||
         std::ranges::any_of(events, [&](const record::EventRow& event) {
           return text_names(event.text, subject);
         });
}

OtherSessions other_sessions(const std::vector<fs::path>& files, const NamedSubject& subject) {
  OtherSessions others;
  for (const fs::path& file : files) {
    if (!is_session_file(file)) {
      continue;
    }
    try {
      const record::SessionReader reader(file);
      if (reader.info().subject != subject.identifier()) {
        others.participants.insert(reader.info().subject);
        if (names_in(reader, subject)) {
          others.naming.push_back(file);
        }
      }
    } catch (const std::exception&) {
      if (const std::string other = identifier_in(file); other != subject.identifier()) {
        others.participants.insert(other);
      }
    }
  }
  return others;
}

/// Folders that hold the participant's sessions, or something made from them.
std::set<fs::path> folders_with(const std::vector<fs::path>& sessions,
                                const std::vector<fs::path>& named) {
  std::set<fs::path> folders;
  for (const auto* list : {&sessions, &named}) {
    for (const fs::path& file : *list) {
      folders.insert(file.parent_path());
    }
  }
  return folders;
}

bool holds_session_files(const fs::path& folder) {
  return std::ranges::any_of(fs::directory_iterator(folder),
                             [](const auto& each) { return is_session_file(each.path()); });
}

/// Whether a file lies in one of some folders, or below one of them in folders that neither name
/// another participant nor are another study's: curves of an export lie in folders with numbers.
bool lies_in(const std::set<fs::path>& folders, const fs::path& file,
             const std::set<std::string>& others) {
  fs::path below;  // names on the way down to the file
  for (fs::path folder = file.parent_path(); !folder.empty(); folder = folder.parent_path()) {
    if (folders.contains(folder)) {
      const std::string way = below.string();
      return std::ranges::none_of(others,
                                  [&](const std::string& other) { return has_word(way, other); });
    }
    if (holds_session_files(folder) || folder == folder.parent_path()) {
      return false;
    }
    below = folder.filename() / below;
  }
  return false;
}

fs::file_time_type first_written(const std::vector<fs::path>& files) {
  fs::file_time_type first = fs::file_time_type::max();
  for (const fs::path& file : files) {
    first = std::min(first, fs::last_write_time(file));
  }
  return first;
}

/// Sorts the files that are no sessions. A file counts by its name; by its text, or without the
/// participant's name beside or below a file that counts, if it is younger than the first session:
/// stimuli and notes stay.
/// @param foreign  folders in which nothing was made from the participant's sessions
void sort_others(const std::vector<fs::path>& files, const std::vector<fs::path>& folders,
                 const NamedSubject& subject, const std::vector<fs::path>& foreign,
                 Withdrawal& found) {
  const fs::file_time_type first = first_written(found.sessions);
  const auto is_foreign = [&](const fs::path& file) {
    return std::ranges::any_of(foreign, [&](const auto& each) { return is_below(file, each); });
  };
  const auto is_younger = [&](const fs::path& file) { return fs::last_write_time(file) >= first; };
  std::vector<fs::path> unnamed;
  for (const fs::path& file : files) {
    if (is_session_file(file) || is_filled_in(file) || file.filename() == kList || is_plan(file)) {
      continue;
    }
    const bool by_path = path_names(file, folders, subject);
    if (by_path || (has_text(file) && text_names(file_text(file), subject))) {
      const bool made = is_made(file) && !is_foreign(file) && (by_path || is_younger(file));
      (made ? found.made : found.others).push_back(file);
    } else if (!is_foreign(file)) {
      unnamed.push_back(file);
    }
  }
  const std::set<fs::path> beside = folders_with(found.sessions, found.made);
  const OtherSessions others = other_sessions(files, subject);
  found.others.insert(found.others.end(), others.naming.begin(), others.naming.end());
  std::ranges::copy_if(unnamed, std::back_inserter(found.made), [&](const fs::path& file) {
    return is_made(file) && lies_in(beside, file, others.participants) && is_younger(file);
  });
  std::ranges::sort(found.made);
}

/// Finds these tables in the study's folder, and beside sessions that are withdrawn.
void find_tables(const std::vector<fs::path>& files, const fs::path& study, Withdrawal& found) {
  std::ranges::copy_if(files, std::back_inserter(found.tables), [&](const fs::path& file) {
    const fs::path parent = file.parent_path();
    const fs::path folder = parent.filename() == "excluded" ? parent.parent_path() : parent;
    return is_filled_in(file) &&
           (is_below(file, study) || std::ranges::any_of(found.sessions, [&](const auto& session) {
              return is_below(session, folder);
            }));
  });
}

/// A row goes on over the ends of lines that stand in quotes.
std::string next_row(std::istringstream& lines) {
  std::string row;
  std::string line;
  do {
    if (!std::getline(lines, line)) {
      break;
    }
    row += line + "\n";
  } while (std::ranges::count(row, '"') % 2 != 0);
  return row;
}

/// Removes the rows whose first column is the participant or one of the participant's session
/// files; a table without any other goes.
void remove_rows(const fs::path& file, const std::string& subject,
                 const std::vector<fs::path>& sessions) {
  std::set<std::string> own{subject};
  for (const fs::path& session : sessions) {
    own.insert(session.filename().string());
  }
  std::istringstream lines(file_text(file));
  std::string kept;
  bool rows = false;
  for (std::string row = next_row(lines); !row.empty(); row = next_row(lines)) {
    if (!own.contains(row.substr(0, row.find(',')))) {
      rows = rows || !kept.empty();
      kept += row;
    }
  }
  rows ? write_whole(file, kept) : static_cast<void>(fs::remove(file));
}

/// Removes the folders of deleted files that are empty now, but not the ones that were given.
void remove_empty(const std::vector<fs::path>& deleted, const std::vector<fs::path>& given) {
  for (const fs::path& file : deleted) {
    fs::path folder = file.parent_path();
    std::error_code error;
    while (std::ranges::find(given, folder) == given.end() && fs::is_empty(folder, error) &&
           !error && fs::remove(folder, error)) {
      folder = folder.parent_path();
    }
  }
}

/// Digests of the participant's session files in a folder, also of excluded ones.
std::vector<std::string> digests_in(const fs::path& folder, const std::vector<fs::path>& sessions) {
  std::vector<std::string> digests;
  for (const fs::path& file : sessions) {
    const fs::path parent = file.parent_path();
    if (file.extension() == ".h5" && (parent == folder || parent == folder / "excluded")) {
      digests.push_back(analysis::sha256_of_file(file));
    }
  }
  return digests;
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

Withdrawal find_withdrawal(const std::vector<fs::path>& folders, const std::string& subject,
                           const ProtocolOf& protocol_of) {
  const std::vector<fs::path> files = files_below(folders);
  const NamedSubject named(subject, files);
  Withdrawal found;
  find_sessions(files, named, OwnStudy(folders.front(), protocol_of), found);
  if (found.sessions.empty()) {
    throw InputError(
        fmt::format("{} has no session file in {}", subject, folders.front().string()));
  }
  sort_others(files, folders, named, foreign_exports(files, folders.front(), named, found.sessions),
              found);
  find_tables(files, folders.front(), found);
  return found;
}

void withdraw(const Withdrawal& found, const std::vector<fs::path>& folders,
              const std::string& subject) {
  std::vector<std::vector<std::string>> digests;
  for (const fs::path& folder : folders) {
    digests.push_back(digests_in(folder, found.sessions));
  }
  for (const auto* list : {&found.sessions, &found.made}) {
    for (const fs::path& file : *list) {
      std::error_code error;
      if (!fs::remove(file, error)) {
        throw RunError(fmt::format("{}: could not be deleted: {}", file.string(), error.message()));
      }
    }
  }
  for (const fs::path& file : found.tables) {
    remove_rows(file, subject, found.sessions);
  }
  for (std::size_t i = 0; i < folders.size(); ++i) {
    note_files(folders[i], kWithdrawn, digests[i]);
  }
  remove_empty(found.sessions, folders);
  remove_empty(found.made, folders);
  const fs::path list = folders.front() / kList;
  const auto now =
      std::chrono::time_point_cast<std::chrono::seconds>(std::chrono::system_clock::now());
  append_text(list, fmt::format("{}{:%FT%TZ},{},{},{}\n",
                                fs::exists(list) ? "" : "time,login,sessions,made_from_sessions\n",
                                now, login_name(), found.sessions.size(), found.made.size()));
}

}  // namespace haptrial::experiments
