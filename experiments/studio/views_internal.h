#pragma once

#include <filesystem>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

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

}  // namespace haptrial::experiments
