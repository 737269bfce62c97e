#pragma once

#include <filesystem>
#include <string>

#include "experiments/command/sessions/run_options.h"

namespace CLI {
class App;
}

namespace haptrial::experiments {

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

}  // namespace haptrial::experiments
