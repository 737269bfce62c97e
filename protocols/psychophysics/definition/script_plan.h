#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "core/base/definition/schema_forward.h"

namespace haptrial::protocols {

/// A program of the experimenter's that is asked while a session goes on, never within a tick.
struct ScriptPlan {
  std::filesystem::path file;  // a Python script (.py), or a program
  double deadline{2.0};        // for an answer [s]
  std::string text;            // what the file held when it was loaded
};

/// Reads [level_script] of the definition, if there is one: the levels are chosen between trials.
/// Problems are noted.
std::optional<ScriptPlan> read_level_script(Table& root);

/// The keys of [observer.script]: virtual participants answer by it.
const Schema<ScriptPlan>& decision_script_schema();

/// Finds the file beside the definition and keeps its text. @throws InputError if it cannot be read
void load_script(ScriptPlan& plan, const std::filesystem::path& folder);

}  // namespace haptrial::protocols
