#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace haptrial {
class Table;
}

namespace haptrial::protocols {

/// A program of the experimenter's that is asked for levels between trials.
struct LevelScriptPlan {
  std::filesystem::path file;  // a Python script (.py), or a program
  double deadline{2.0};        // for an answer, where a person waits [s]
  std::string text;            // what the file held when it was loaded
};

/// Reads the table [level_script], if there is one: file, [deadline]. Problems are noted.
std::optional<LevelScriptPlan> read_level_script(Table& root);

/// Finds the file beside the definition and keeps its text. @throws InputError if it cannot be read
void load_level_script(LevelScriptPlan& plan, const std::filesystem::path& folder);

}  // namespace haptrial::protocols
