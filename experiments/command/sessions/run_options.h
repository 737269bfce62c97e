#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/record/rows/session_types.h"

namespace haptrial::protocols {
struct Definition;
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

}  // namespace haptrial::experiments
