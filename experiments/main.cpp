// The command. Exit status: 0 done, 1 failed, 2 bad input.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "core/base/error.h"
#include "experiments/commands.h"
#include "experiments/version.h"

namespace {

namespace experiments = haptrial::experiments;

constexpr int kFailed = 1;
constexpr int kBadInput = 2;

CLI::App* subcommand(CLI::App& app, const char* name, const char* what, const char* example) {
  CLI::App* sub = app.add_subcommand(name, what);
  sub->footer(std::string("Example:\n  ") + example);
  return sub;
}

/// Declares the subcommands; the one that is given sets `status`.
class Commands {
 public:
  Commands(CLI::App& app, int& status) : app_(app), status_(status) {
    add_dry_run();
    add_run();
    add_analyze();
    add_info();
    add_validate();
    add_devices();
  }

 private:
  void add_dry_run() {
    CLI::App* sub =
        subcommand(app_, "dry-run", "Run a study with virtual subjects, as fast as it goes",
                   "haptrial dry-run experiments/force_training.toml --jobs 2");
    sub->add_option("DEFINITION", dry_run_.definition, "Experiment definition (.toml)")->required();
    sub->add_option("--subjects", dry_run_.subjects, "How many; as the definition says by default");
    sub->add_option("--seed", dry_run_.seed, "Of every random number (1)");
    sub->add_option("--jobs", dry_run_.jobs, "Threads; one per processor by default");
    sub->add_option("--out", dry_run_.out, "New folder for the session files (out/NAME-001)");
    sub->add_option("--trials", dry_run_.trials, "Only the first so many of each subject");
    sub->add_option("--frames", dry_run_.frames,
                    "Also write so many pictures of each pass, as the subject saw it (0)");
    sub->callback([this] { status_ = experiments::dry_run(dry_run_); });
  }

  void add_run() {
    CLI::App* sub = subcommand(app_, "run", "Run one participant's session in real time",
                               "haptrial run experiments/force_training.toml --subject P01");
    sub->add_option("DEFINITION", run_.definition, "Experiment definition (.toml)")->required();
    sub->add_option("--subject", run_.subject, "Identifier: letters, digits, '-', '_'")->required();
    sub->add_option("--device", run_.device, "Device (virtual)");
    sub->add_option("--seed", run_.seed, "Of the study (1)");
    sub->add_option("--participant", run_.participant,
                    "Number that sets the order of conditions; at the end of ID by default");
    sub->add_option("--trials", run_.trials, "Only the first so many");
    sub->add_option("--out", run_.out, "Folder for the session file (out/sessions)");
    sub->callback([this] { status_ = experiments::run(run_); });
  }

  void add_analyze() {
    CLI::App* sub =
        subcommand(app_, "analyze", "Score and test the sessions of a folder; write the report",
                   "haptrial analyze out/force_training-001");
    sub->add_option("DIR", path_, "Folder of session files (.h5)")->required();
    sub->add_option("--jobs", jobs_, "Threads; one per processor by default");
    sub->callback([this] { status_ = experiments::analyze(path_, jobs_); });
  }

  void add_info() {
    CLI::App* sub =
        subcommand(app_, "info", "Say what a session file holds and whether it is complete",
                   "haptrial info out/force_training-001/S01.h5");
    sub->add_option("FILE", path_, "Session file (.h5)")->required();
    sub->callback([this] { status_ = experiments::info(path_); });
  }

  void add_validate() {
    CLI::App* sub = subcommand(app_, "validate", "Check a definition and say what it plans",
                               "haptrial validate experiments/force_training.toml");
    sub->add_option("DEFINITION", path_, "Experiment definition (.toml)")->required();
    sub->callback([this] { status_ = experiments::validate(path_); });
  }

  void add_devices() {
    CLI::App* sub = subcommand(app_, "devices", "List the devices", "haptrial devices");
    sub->callback([this] { status_ = experiments::devices(); });
  }

  CLI::App& app_;
  int& status_;
  experiments::DryRunOptions dry_run_;
  experiments::RunOptions run_;
  std::string path_;
  std::optional<int> jobs_;
};

/// A mistyped subcommand by its name, rather than as one that is missing.
void check_subcommand(CLI::App& app, int argc, char** argv) {
  std::string known;
  for (const CLI::App* sub : app.get_subcommands([](CLI::App*) { return true; })) {
    known += (known.empty() ? "" : ", ") + sub->get_name();
    if (argc > 1 && sub->get_name() == argv[1]) {
      return;
    }
  }
  if (argc > 1 && argv[1][0] != '-') {
    throw haptrial::InputError(
        fmt::format("'{}' is not a subcommand; allowed: {}", argv[1], known));
  }
}

int run_command(int argc, char** argv) {
  CLI::App app("Force-feedback experiments: run them, record them, know what they showed.");
  app.name("haptrial");
  app.set_version_flag("--version", fmt::format("haptrial {} ({})", experiments::program_version(),
                                                experiments::program_commit()));
  app.require_subcommand(1);
  app.footer("haptrial SUBCOMMAND --help shows an example of each.");
  int status = 0;
  const Commands commands(app, status);
  check_subcommand(app, argc, argv);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& asked) {
    return app.exit(asked);
  } catch (const CLI::ParseError& error) {
    fmt::print(stderr, "haptrial: {}; see haptrial --help\n", error.what());
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
    fmt::print(stderr, "haptrial: {}\n", error.what());
    return kBadInput;
  } catch (const std::exception& error) {
    fmt::print(stderr, "haptrial: {}\n", error.what());
    return kFailed;
  }
}
