#include "experiments/command/line/whole_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <span>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/exception_words.h"
#include "experiments/command/libraries.h"
#include "experiments/command/line/command_line_check_internal.h"
#include "experiments/command/program_words.h"
#include "experiments/command/start/examples.h"
#include "experiments/command/subcommand.h"
#include "experiments/runner/version.h"
#include "experiments/studies/drilling/bone_study.h"
#include "experiments/studies/force/force_study.h"
#include "experiments/studies/psychophysics/trials_study.h"
#include "experiments/studies/registry.h"

namespace haptrial::experiments {
namespace {

constexpr int kFailed = 1;
constexpr int kBadInput = 2;

/// Also where nobody reads it any more, as in a terminal that was closed.
void complain(const std::string& sentence) {
  [[maybe_unused]] const int written = std::fputs(("haptrial: " + sentence + "\n").c_str(), stderr);
}

/// Writes -.5 as -0.5, which CLI11 would take for an option.
void add_leading_zero(std::string& word) {
  if (word.size() > 2 && word.starts_with("-.") && word[2] >= '0' && word[2] <= '9') {
    word.insert(1, "0");
  }
}

/// The words of a line, those of another program as one.
std::vector<std::string> joined_words(std::span<char* const> line) {
  std::vector<std::string> words(line.begin(), line.end());
  const auto option = std::ranges::find(words, kProgramOption);
  std::for_each(words.begin(), option, add_leading_zero);
  if (words.end() - option > 2) {
    for (auto word = option + 2; word != words.end(); ++word) {
      *(option + 1) += kProgramSeparator + *word;
    }
    words.erase(option + 2, words.end());
  }
  return words;
}

/// Reads a line of words and runs the subcommand that it gives.
/// @returns the exit status. @throws what the subcommand throws
int run_line(std::span<char* const> whole) {
  std::vector<std::string> joined = joined_words(whole);
  std::vector<char*> line;
  for (std::string& word : joined) {
    line.push_back(word.data());
  }
  CLI::App app("Run force-feedback experiments, record them and analyse the results.");
  app.name("haptrial");
  app.set_version_flag("--version", fmt::format("haptrial {} ({})\n{}", program_version(),
                                                program_commit(), libraries()));
  app.require_subcommand(1);
  app.footer(
      "First steps:\n"
      "  haptrial validate first_experiment\n"
      "  haptrial dry-run first_experiment --subjects 4 --out out/try\n"
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

/// The exit status of a program: what `command` returns, or 1 or 2 after a sentence on standard
/// error for what it threw.
int exit_status(const std::function<int()>& command) {
  try {
    const int status = command();
    if (std::fflush(stdout) != 0) {
      throw RunError("standard output cannot be written");
    }
    return status;
  } catch (const std::exception& error) {
    complain(haptrial::sentence_of(error));
    return is_bad_input(error) ? kBadInput : kFailed;
  }
}

}  // namespace

int whole_command(int argc, char** argv, const std::function<void()>& add_own) {
  return exit_status([&] {
    add_shipped_studies();
    if (add_own) {
      add_own();
    }
    return run_line({argv, static_cast<std::size_t>(argc)});
  });
}

namespace {

/// Wherever a definition is asked for, a shipped one may be named.
void accept_examples(CLI::App& app) {
  for (CLI::App* sub : app.get_subcommands({})) {
    accept_examples(*sub);
  }
  for (CLI::Option* option : app.get_options()) {
    if (option->get_name() == "DEFINITION") {
      option->transform(CLI::Validator(
          [](std::string& given) {
            given = definition_or_example(given);
            return std::string();
          },
          ""));
    }
  }
}

}  // namespace

void declare_subcommands(CLI::App& app, int& status) {
  add_examples(app, status);
  add_new(app, status);
  add_set(app, status);
  add_texts(app, status);
  add_doctor(app, status);
  add_studio(app, status);
  add_dry_run(app, status);
  add_start(app, status);
  add_run(app, status);
  add_secret(app, status);
  add_roster(app, status);
  add_next(app, status);
  add_withdraw(app, status);
  add_analyze(app, status);
  add_export(app, status);
  add_import(app, status);
  add_align(app, status);
  add_evaluate(app, status);
  add_exam(app, status);
  add_compare(app, status);
  add_judge(app, status);
  add_statistics(app, status);
  add_info(app, status);
  add_record(app, status);
  add_recover(app, status);
  add_replay(app, status);
  add_validate(app, status);
  add_show(app, status);
  add_plan(app, status);
  add_keys(app, status);
  add_power(app, status);
  add_devices(app, status);
  add_device_test(app, status);
  add_mesh(app, status);
  add_bone(app, status);
  add_deform(app, status);
  add_spectrum(app, status);
  add_rate(app, status);
  accept_examples(app);
}

void add_shipped_studies() {
  add_study(force_study());
  add_study(bone_study());
  add_study(trials_study());
}

}  // namespace haptrial::experiments
