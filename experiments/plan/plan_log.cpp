#include "experiments/plan/plan_log.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <sstream>

#include "analysis/files/sha256.h"
#include "core/base/error.h"
#include "core/base/file_text.h"
#include "core/record/read/session_reader.h"

namespace haptrial::experiments {
namespace {

namespace fs = std::filesystem;

/// The words of a line without its link.
std::string words_of(const PlanEntry& entry) {
  return fmt::format("{}\t{}\t{}\t{}", entry.time, entry.login, entry.what, entry.detail);
}

std::string link_of(const std::string& before, const PlanEntry& entry) {
  return analysis::sha256_of(before + "\n" + words_of(entry));
}

PlanEntry entry_of(const std::string& line) {
  std::istringstream in(line);
  PlanEntry entry;
  for (std::string* field : {&entry.time, &entry.login, &entry.what, &entry.detail}) {
    std::getline(in, *field, '\t');
  }
  std::getline(in, entry.link);
  return entry;
}

/// A line whose end is missing was cut off as it was written, and is none.
std::string whole_lines(const std::string& text) { return text.substr(0, text.rfind('\n') + 1); }

PlanLog log_from(const std::string& text, const std::string& plan_digest) {
  PlanLog log;
  log.head = plan_digest;
  std::istringstream lines(whole_lines(text));
  for (std::string line; std::getline(lines, line);) {
    const PlanEntry entry = entry_of(line);
    if (log.broken.empty() && entry.link != link_of(log.head, entry)) {
      log.broken = log.entries.empty()
                       ? std::string("the plan or the first line of its log was changed")
                       : fmt::format(
                             "line {} of the log, or one before it, was changed or taken "
                             "out",
                             log.entries.size() + 1);
    }
    log.head = entry.link;
    log.entries.push_back(entry);
  }
  return log;
}

/// An open file that no other process may lock.
class LockedLog {
 public:
  explicit LockedLog(const fs::path& file)
      : file_(file),
        descriptor_(::open(file.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666)) {
    if (descriptor_ < 0 || ::flock(descriptor_, LOCK_EX) != 0) {
      fail();
    }
  }
  ~LockedLog() {
    if (descriptor_ >= 0) {
      ::close(descriptor_);
    }
  }
  LockedLog(const LockedLog&) = delete;
  LockedLog& operator=(const LockedLog&) = delete;

  /// Adds a line behind the whole ones; what is left of one that was cut off goes.
  void add(const std::string& line) const {
    const std::size_t whole = whole_lines(file_text(file_)).size();
    if (::ftruncate(descriptor_, static_cast<off_t>(whole)) != 0) {
      fail();
    }
    const ssize_t written = ::write(descriptor_, line.data(), line.size());
    if (written != static_cast<ssize_t>(line.size()) || ::fsync(descriptor_) != 0) {
      fail();
    }
  }

 private:
  [[noreturn]] void fail() const {
    throw RunError(fmt::format("{}: cannot be written ({})", file_.string(), std::strerror(errno)));
  }
  fs::path file_;
  int descriptor_;
};

/// Tabs and ends of lines separate fields.
std::string plain(std::string text) {
  std::ranges::replace_if(
      text, [](char c) { return c == '\t' || c == '\n' || c == '\r'; }, ' ');
  return text;
}

}  // namespace

std::vector<std::string> values_in(const std::string& text, const std::string& name) {
  std::vector<std::string> found;
  std::istringstream words(text);
  bool inside = false;
  for (std::string word; std::getline(words, word, ' ');) {
    const auto equals = word.find('=');
    const bool names = equals != std::string::npos && equals > 0 &&
                       std::ranges::all_of(word.substr(0, equals), [](unsigned char c) {
                         return std::isalnum(c) != 0 || c == '_';
                       });
    if (names) {
      inside = word.substr(0, equals) == name;
      word = word.substr(equals + 1);
    }
    if (inside && names) {
      found.push_back(word);
    } else if (inside) {
      found.back() += " " + word;
    }
  }
  return found;
}

fs::path log_beside(const fs::path& plan) {
  fs::path log = plan;
  return log.replace_extension(".log");
}

PlanLog read_plan_log(const fs::path& plan) {
  const fs::path file = log_beside(plan);
  return log_from(fs::exists(file) ? file_text(file) : "", analysis::sha256_of(file_text(plan)));
}

void note_in_log(const fs::path& plan, const std::string& what, const std::string& detail) {
  const LockedLog file(log_beside(plan));
  PlanEntry entry{utc_now(), plain(login_name()), what, plain(detail), ""};
  entry.link = link_of(read_plan_log(plan).head, entry);
  file.add(fmt::format("{}\t{}\n", words_of(entry), entry.link));
}

std::string plan_event(const fs::path& folder) {
  const auto plan = plan_in(folder);
  return plan ? fmt::format("plan={} link={}", read_study_plan(*plan).sha256,
                            read_plan_log(*plan).head)
              : "";
}

void note_closed_session(const fs::path& file) {
  if (const auto plan = plan_in(file.parent_path())) {
    note_in_log(*plan, kSessionClosed,
                fmt::format("begun={} sha256={}", record::SessionReader(file).info().start_utc,
                            analysis::sha256_of_file(file)));
  }
}

void note_files(const fs::path& folder, const std::string& what,
                const std::vector<std::string>& digests) {
  const auto plan = plan_in(folder);
  if (plan && !digests.empty()) {
    note_in_log(*plan, what, fmt::format("sha256={}", fmt::join(digests, " sha256=")));
  }
}

std::vector<std::size_t> seen_analyses(const PlanLog& log) {
  std::vector<std::size_t> seen;
  for (std::size_t i = 0; i < log.entries.size(); ++i) {
    const bool failed = i + 1 < log.entries.size() && log.entries[i + 1].what == kAnalysisFailed;
    if (log.entries[i].what == kAnalysed && !failed) {
      seen.push_back(i);
    }
  }
  return seen;
}

}  // namespace haptrial::experiments
