#include "experiments/command/line/whole_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <span>
#include <string>

#include "core/base/error.h"
#include "experiments/command/line/command_line.h"
#include "experiments/command/line/command_line_check_internal.h"
#include "experiments/runner/version.h"

namespace haptrial::experiments {
namespace {

constexpr int kFailed = 1;
constexpr int kBadInput = 2;

/// Also where nobody reads it any more, as in a terminal that was closed.
void complain(const std::string& sentence) {
  [[maybe_unused]] const int written = std::fputs(("haptrial: " + sentence + "\n").c_str(), stderr);
}

int run_command(int argc, char** argv) {
  CLI::App app("Run force-feedback experiments, record them and analyse the results.");
  app.name("haptrial");
  app.set_version_flag("--version",
                       fmt::format("haptrial {} ({})", program_version(), program_commit()));
  app.require_subcommand(1);
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
  const auto words = std::span(argv, static_cast<std::size_t>(argc)).subspan(1);
  check_words(app, words);
  try {
    app.parse(argc, argv);
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
