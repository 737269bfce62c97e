// The command. Exit status: 0 done, 1 failed, 2 bad input.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <span>
#include <string>

#include "core/base/error.h"
#include "experiments/command_line.h"
#include "experiments/version.h"

namespace {

namespace experiments = haptrial::experiments;

constexpr int kFailed = 1;
constexpr int kBadInput = 2;

/// Also where nobody reads it any more, as in a terminal that was closed.
void complain(const std::string& sentence) {
  [[maybe_unused]] const int written = std::fputs(("haptrial: " + sentence + "\n").c_str(), stderr);
}

/// A mistyped or missing subcommand by its name, with those there are.
/// @param words  what was typed after `name`
void check_subcommands(const CLI::App& app, const std::string& name, std::span<char* const> words) {
  std::string known;
  for (const CLI::App* sub : app.get_subcommands([](const CLI::App*) { return true; })) {
    known += (known.empty() ? "" : ", ") + sub->get_name();
    if (!words.empty() && sub->get_name() == words[0]) {
      check_subcommands(*sub, fmt::format("{} {}", name, words[0]), words.subspan(1));
      return;
    }
  }
  if (known.empty() || (!words.empty() && words[0][0] == '-')) {
    return;
  }
  throw haptrial::InputError(
      words.empty()
          ? fmt::format("{} needs a subcommand; allowed: {}", name, known)
          : fmt::format("'{}' is not a subcommand of {}; allowed: {}", words[0], name, known));
}

int run_command(int argc, char** argv) {
  CLI::App app("Force-feedback experiments: run them, record them, know what they showed.");
  app.name("haptrial");
  app.set_version_flag("--version", fmt::format("haptrial {} ({})", experiments::program_version(),
                                                experiments::program_commit()));
  app.require_subcommand(1);
  app.footer("haptrial SUBCOMMAND --help shows an example of each.");
  int status = 0;
  experiments::declare_subcommands(app, status);
  check_subcommands(app, "haptrial", std::span(argv, static_cast<std::size_t>(argc)).subspan(1));
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& asked) {
    return app.exit(asked);
  } catch (const CLI::ParseError& error) {
    complain(std::string(error.what()) + "; see haptrial --help");
    return kBadInput;
  }
  return status;
}

}  // namespace

int main(int argc, char** argv) {
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
