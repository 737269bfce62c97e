#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/definition/given_values.h"
#include "core/record/rows/session_types.h"

namespace haptrial::protocols {
struct Definition;
}

namespace CLI {
class App;
}

namespace CLI {
class App;
}

namespace haptrial::experiments {

/// Options of haptrial run, which command_run.cpp describes.
struct RunOptions {
  std::string definition;
  std::string subject;
  std::vector<std::string> devices{"virtual"};  // in the order in which the protocol has them
  std::string library;
  std::string seed;  // empty: that of the study's sessions (session_seed())
  std::optional<int> participant;
  std::optional<int> session;
  std::string case_name;  // of a curriculum; empty: the one that comes next
  std::string out;
  std::string backup;
  std::optional<int> trials;
  std::string tutor;
  std::optional<int> teach;
  std::string learn_from;
  std::string secret;
  bool console{false};
  std::vector<std::string> auxiliary_pages;
  bool keyboard{false};
  std::optional<std::string> address;
  std::optional<int> port;
  bool remote{false};
  std::string watch;  // address of a copy of the console that only looks
  bool window{false};
  bool stream{false};
  bool stream_optional{false};
  bool resume{false};
  bool pilot{false};
  bool checked{false};             // `start` has printed its checklist
  std::vector<std::string> set{};  // KEY=VALUE, of a pilot
  std::string language;
  record::Participant person;
};

/// Folder of the session files: `out`, or where they go if it is empty.
std::string session_folder(const RunOptions& options);
/// The session's file, of a subject that is chosen.
std::filesystem::path session_file(const RunOptions& options, const protocols::Definition& setup);
/// Folder for backups: the option's, or the room's; empty: none.
std::string backup_folder(const RunOptions& options, const protocols::Definition& setup);

/// A session that has come to an end, or was stopped with trials left.
struct RunEnd {
  std::filesystem::path file;  // without ".partial"
  std::string subject;
  bool stopped{false};  // --resume goes on with it
};

/// DEFINITION and the options of `run`, which `start` has as well.
void declare_run_options(CLI::App& app, RunOptions& options);

/// Runs the session that the options ask for, of whoever is next if they name nobody, and makes its
/// backup. @throws InputError, RunError
RunEnd run_command(const RunOptions& options);

/// Adds --set KEY=VALUE, which may be repeated. @param app, set  outlive each other
void declare_set_option(CLI::App& app, std::vector<std::string>& set);

/// The keys that --set gave. @throws InputError for a text that is not KEY=VALUE
std::vector<GivenKey> given_keys(const std::vector<std::string>& set);

}  // namespace haptrial::experiments
