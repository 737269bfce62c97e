#pragma once

#include <string>

namespace haptrial::test {

/// Output and exit status of a command.
struct CommandResult {
  int status{-1};      // exit status; 128 + signal where it was killed
  std::string output;  // standard output
  std::string errors;  // standard error
};

/// Runs a shell command line in which `haptrial` is the built command, and "$HAPTRIAL" its path.
CommandResult run_command(const std::string& line);

}  // namespace haptrial::test
