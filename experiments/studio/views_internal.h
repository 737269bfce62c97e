#pragma once

#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <list>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include "core/base/error.h"
#include "core/base/file_text.h"
#include "experiments/server/server.h"
#include "experiments/studio/commands.h"
#include "experiments/studio/line_commands.h"
#include "experiments/studio/remarks.h"
#include "experiments/studio/session_files.h"
#include "experiments/studio/study_folder.h"

namespace haptrial::experiments {

/// Answers to the page's requests, each by a command of the program. Every answer of a command has
/// its line as "command". Any thread. InputError for what is not allowed, RunError for what failed.
class StudioViews {
 public:
  /// @param folder, commands, tried, page_maker  outlive it
  StudioViews(const StudyFolder& folder, Commands& commands, LineCommands& tried,
              LineCommands& page_maker, std::filesystem::path libraries);
  ~StudioViews();
  StudioViews(const StudioViews&) = delete;
  StudioViews& operator=(const StudioViews&) = delete;

  // Home
  nlohmann::json studies() const;
  nlohmann::json study(const std::string& file) const;
  nlohmann::json examples() const;
  nlohmann::json machine() const;
  nlohmann::json begin(const std::string& name, const std::string& from) const;

  // Definition
  nlohmann::json text(const std::string& file) const;
  nlohmann::json validate(const std::string& file, const std::string& text) const;
  /// @param trial  from 1, of the first session  @param virtual_trial  with a virtual participant's
  /// @param language  of headings, "de" or "en"
  nlohmann::json preview(const std::string& file, const std::string& text, int trial,
                         bool virtual_trial, const std::string& language) const;
  /// A preview that was made, once.
  WebAnswer preview_page(const std::string& number) const;
  /// Begins to try a trial with a pointer. @param trial  as of preview()
  nlohmann::json try_trial(const std::string& file, const std::string& text, int trial) const;
  /// Answers to lines of a trial that is tried. @param number  of it
  nlohmann::json try_move(int number, const nlohmann::json& lines) const;
  nlohmann::json try_end(int number) const;
  /// The keys that a text states (`set --list`).
  nlohmann::json keys(const std::string& file, const std::string& text) const;
  /// The text after one edit (`set`). @param edit  "add", "remove", or else the key gets the value
  nlohmann::json set_key(const std::string& file, const std::string& text, const std::string& key,
                         const std::string& edit, const std::string& value) const;
  nlohmann::json save(const std::string& file, const std::string& text,
                      const std::string& stamp) const;
  nlohmann::json schema(const std::string& protocol) const;

  // Rehearsal, sessions, results
  nlohmann::json rehearse(const std::string& file, int subjects, std::optional<int> setup) const;
  /// Writes the study's preregistration beside its definition.
  nlohmann::json plan(const std::string& file) const;
  /// Simulates the study many times, as its table [power] says.
  nlohmann::json power(const std::string& file) const;
  nlohmann::json analyze(const std::string& file, const std::string& folder) const;
  nlohmann::json jobs() const;
  nlohmann::json job(const std::string& number) const;
  nlohmann::json sessions(const std::string& file) const;
  nlohmann::json info(const std::string& file) const;

  /// A report, figure or table. @param download  to be kept, not shown
  WebAnswer file(const std::string& name, bool download) const;
  /// A file of CodeMirror.
  WebAnswer library(const std::string& name) const;

 private:
  /// Nothing, if the folder is not there or lies elsewhere.
  SessionFolder held_in(const std::string& name) const;
  std::filesystem::path preview_file(int number) const;
  std::string page_answer_to(const std::string& asked) const;
  CommandResult run_good(const CommandWords& words) const;
  void add_roster(const std::string& file, nlohmann::json& out) const;
  void add_last_event(const std::string& folder, nlohmann::json& out) const;

  const StudyFolder& folder_;
  Commands& commands_;
  LineCommands& tried_;
  LineCommands& page_maker_;
  mutable std::mutex pages_mutex_;
  mutable int pages_{0};  // number of the command that makes pages; 0: none runs
  std::filesystem::path libraries_;
  std::filesystem::path scratch_;  // for what commands write and nobody keeps
};

inline constexpr std::uintmax_t kMostDefinition = 2'000'000;  // [bytes]

/// A file that is removed at the end.
class ShortLivedFile {
 public:
  explicit ShortLivedFile(std::filesystem::path file) : file_(std::move(file)) {}
  ~ShortLivedFile() {
    std::error_code ignored;
    std::filesystem::remove(file_, ignored);
  }
  ShortLivedFile(const ShortLivedFile&) = delete;
  ShortLivedFile& operator=(const ShortLivedFile&) = delete;
  const std::filesystem::path& path() const { return file_; }

 private:
  std::filesystem::path file_;
};

/// A number that no other request has.
inline int next_number() {
  static std::atomic<int> number{0};
  return ++number;
}

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (auto at = text.find(from); at != text.npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
  return text;
}

/// A definition as it is being written. It lies beside the saved one, since it may name files that
/// do, with copies of that one's texts in other languages.
class Draft {
 public:
  /// @param folder  of the studio, in which commands run
  Draft(const std::filesystem::path& definition, const std::filesystem::path& folder,
        const std::string& text)
      : stem_(definition.stem().string()),
        draft_stem_(fmt::format(".{}.draft-{}-{}", stem_, ::getpid(), next_number())),
        file_(definition.parent_path() / (draft_stem_ + ".toml")),
        name_(file_.path().lexically_relative(folder).string()) {
    if (text.size() > kMostDefinition) {
      throw InputError(
          fmt::format("the definition has {} bytes; allowed: {}", text.size(), kMostDefinition));
    }
    write_text(file_.path(), text);
    copy_translations(definition.parent_path());
  }
  const std::string& name() const { return name_; }
  /// A command's output about the draft, as it would have been about the definition.
  std::string renamed(const std::string& output) const {
    return replaced(output, draft_stem_, stem_);
  }

 private:
  void copy_translations(const std::filesystem::path& folder) {
    const std::string begin = stem_ + ".texts.";
    std::error_code ignored;  // a file that goes meanwhile
    for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
      const std::string name = entry.path().filename().string();
      if (name.starts_with(begin) && name.ends_with(".toml")) {
        translations_.emplace_back(folder / (draft_stem_ + name.substr(stem_.size())));
        std::filesystem::copy_file(entry.path(), translations_.back().path(), ignored);
      }
    }
  }

  std::string stem_;
  std::string draft_stem_;
  ShortLivedFile file_;
  std::list<ShortLivedFile> translations_;
  std::string name_;
};

/// @throws InputError for a text that is no whole number from 0 to 999999999
inline int number_of(const std::string& text) {
  if (text.empty() || text.size() > 9 || text.find_first_not_of("0123456789") != text.npos) {
    throw InputError("a number of the address is not a whole number from 0 to 999999999");
  }
  return std::stoi(text);
}

/// The content policy of every page within a frame.
inline constexpr const char* kFramedPolicy =
    "default-src 'none'; style-src 'unsafe-inline'; img-src data:; font-src data:; "
    "frame-ancestors 'self'";

/// A report is data: it runs nothing, loads nothing, and only the studio may frame it.
inline WebAnswer framed(const std::string& type, std::string text) {
  WebAnswer answer{200, type, std::move(text)};
  answer.headers = {
      {"Content-Security-Policy", fmt::format("sandbox allow-popups; {}", kFramedPolicy)},
      {"X-Frame-Options", "SAMEORIGIN"},
      {"Cross-Origin-Opener-Policy", "unsafe-none"}};
  return answer;
}

/// Answers to the page's requests about sessions with participants, devices and files for other
/// programs, each by a command of the program. Any thread. Throws as StudioViews does.
class SessionViews {
 public:
  /// @param folder, commands  outlive it
  SessionViews(const StudyFolder& folder, Commands& commands)
      : folder_(folder), commands_(commands) {}

  /// The checklist before a session: "checks", "ready", or "failure".
  nlohmann::json checklist(const SessionChoice& choice) const;
  /// Starts a session as a job.
  nlohmann::json begin(const SessionChoice& choice) const;
  /// Writes the emergency card beside the sessions. @returns its "file"
  nlohmann::json card(const SessionChoice& choice) const;
  /// The newest session that was started here, with its console's addresses while it runs; null
  /// if there is none.
  nlohmann::json session() const;

  /// Devices of this computer as rows of name, state and what was found.
  nlohmann::json devices() const;
  /// Tests a device as a job. @param seconds  1 to 600
  nlohmann::json test_device(const std::string& device, int seconds) const;
  /// Reads a device, or the channels of a definition, as a job. @param seconds  1 to 600
  nlohmann::json read_device(const std::string& device, int seconds) const;
  nlohmann::json read_channels(const std::string& file, int seconds) const;

  /// Writes a folder of sessions in another format as a job.
  /// @param format  "csv", "bids" or "pdf"
  nlohmann::json hand_over(const std::string& file, const std::string& folder,
                           const std::string& format) const;

  /// Lists the files that a participant's withdrawal deletes from the sessions and exports of a
  /// study. @param sure  deletes them
  nlohmann::json withdraw(const std::string& file, const std::string& subject, bool sure) const;

 private:
  const StudyFolder& folder_;
  Commands& commands_;
};

}  // namespace haptrial::experiments
