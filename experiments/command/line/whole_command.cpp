#include "experiments/command/line/whole_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "experiments/command/line/command_line.h"
#include "experiments/command/line/command_line_check_internal.h"
#include "experiments/command/start/libraries.h"
#include "experiments/plugin/load_plugin.h"
#include "experiments/runner/version.h"

namespace haptrial::experiments {
namespace {

constexpr int kFailed = 1;
constexpr int kBadInput = 2;

/// Also where nobody reads it any more, as in a terminal that was closed.
void complain(const std::string& sentence) {
  [[maybe_unused]] const int written = std::fputs(("haptrial: " + sentence + "\n").c_str(), stderr);
}

/// The line without --plugin FILE, wherever it stands: plug-ins are loaded before the other words
/// are read, since they decide what may stand there.
std::vector<char*> load_named_plugins(int argc, char** argv) {
  if (const char* folder = std::getenv("HAPTRIAL_PLUGINS"); folder != nullptr && *folder != '\0') {
    load_plugins(folder);
  }
  constexpr std::string_view kJoined = "--plugin=";
  std::vector<char*> rest;
  for (int i = 0; i < argc; ++i) {
    const std::string_view word = argv[i];
    if (word == "--") {
      rest.insert(rest.end(), argv + i, argv + argc);
      break;
    }
    if (word != "--plugin" && !word.starts_with(kJoined)) {
      rest.push_back(argv[i]);
      continue;
    }
    const std::string_view next = i + 1 < argc ? argv[i + 1] : "";
    const std::string_view file = word == "--plugin" ? next : word.substr(kJoined.size());
    i += word == "--plugin" ? 1 : 0;
    if (file.empty()) {
      throw InputError("--plugin has no value; write a file (.so) after it");
    }
    load_plugin(file);
  }
  return rest;
}

int run_command(int argc, char** argv) {
  std::vector<char*> line = load_named_plugins(argc, argv);
  CLI::App app("Run force-feedback experiments, record them and analyse the results.");
  app.name("haptrial");
  app.set_version_flag("--version", fmt::format("haptrial {} ({})\n{}", program_version(),
                                                program_commit(), libraries()));
  app.require_subcommand(1);
  std::vector<std::string> plugins;  // read already
  app.add_option("--plugin", plugins,
                 "Plug-in (.so) to load, for any subcommand; repeated for each plug-in. The folder "
                 "HAPTRIAL_PLUGINS of the environment is loaded first");
  app.footer(
      "First steps:\n"
      "  haptrial validate experiments/force_training.toml\n"
      "  haptrial dry-run experiments/force_training.toml --subjects 4 --out out/try\n"
      "  haptrial analyze out/try\n"
      "\n'haptrial SUBCOMMAND --help' shows the options and an example of a subcommand.\n"
      "Documentation: README.md and docs/ of the source.\n"
      "Exit status: 0 done, 1 failed, 2 bad input.");
  int status = 0;
  declare_subcommands(app, status);
  const auto words = std::span<char* const>(line).subspan(1);
  check_words(app, words);
  try {
    app.parse(static_cast<int>(line.size()), line.data());
  } catch (const CLI::Success& asked) {
    return app.exit(asked);
  } catch (const CLI::ParseError& error) {
    complain(sentence_of(app, words, error));
    return kBadInput;
  }
  return status;
}

}  // namespace

int whole_command(int argc, char** argv) {
  try {
    const int status = run_command(argc, argv);
    if (std::fflush(stdout) != 0) {
      throw haptrial::RunError("standard output cannot be written");
    }
    return status;
  } catch (const haptrial::InputError& error) {
    complain(error.what());
    return kBadInput;
  } catch (const std::exception& error) {
    complain(error.what());
    return kFailed;
  }
}

}  // namespace haptrial::experiments
