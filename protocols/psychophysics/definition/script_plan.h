#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace haptrial {
class Table;
}

namespace haptrial::protocols {

/// A program of the experimenter's that is asked while a session goes on, never within a tick.
struct ScriptPlan {
  std::filesystem::path file;  // a Python script (.py), or a program
  double deadline{2.0};        // for an answer [s]
  std::string text;            // what the file held when it was loaded
};

/// Reads [level_script] of the definition, if there is one: the levels are chosen between trials.
/// Keys: file, [deadline], which holds if a person waits. Problems are noted.
std::optional<ScriptPlan> read_level_script(Table& root);

/// Reads [observer.script], if there is one: virtual participants answer by it. Keys: file,
/// [deadline]. Problems are noted.
std::optional<ScriptPlan> read_decision_script(Table& observer);

/// Finds the file beside the definition and keeps its text. @throws InputError if it cannot be read
void load_script(ScriptPlan& plan, const std::filesystem::path& folder);

}  // namespace haptrial::protocols
