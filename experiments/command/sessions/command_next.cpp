#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "experiments/command/arguments.h"
#include "experiments/command/sessions/next_session.h"
#include "experiments/command/subcommand.h"
#include "experiments/studies/experiment.h"
#include "experiments/study/roster.h"

namespace haptrial::experiments {
namespace {

struct NextOptions {
  std::string definition;
  std::string folder;
  std::optional<int> jobs;
};

int next(const NextOptions& options) {
  const Experiment experiment = load_experiment(options.definition);
  RosterRequest request;
  request.protocol = &experiment.study->protocol();
  request.definition = experiment.definition.get();
  request.definition_file = options.definition;
  request.folder = options.folder;
  request.find_case = find_case_of(experiment, options.definition);
  const Roster roster = make_roster(request);
  const auto result = study_standing(experiment, options.folder, checked_jobs(options.jobs));
  if (result) {
    fmt::print("{}\n", words_of(*result));
  }
  const std::vector<RosterNext> next = next_sessions(roster, result);
  if (!next.empty()) {
    fmt::print("next: {}\n      {}\n", words_of(next.front(), roster.sessions),
               next.front().command);
  } else {
    fmt::print("{}\n", words_without_next(roster, result));
  }
  return 0;
}

}  // namespace

void add_next(CLI::App& app, int& status) {
  CLI::App* sub =
      subcommand(app, "next", "Show whether a study goes on, and who is next",
                 "haptrial next curl_field out/curl_field", {"nothing", "guide-experimenter.md"});
  auto& o = options_of<NextOptions>(*sub, status, next);
  sub->add_option("DEFINITION", o.definition, "Experiment definition (.toml)")->required();
  sub->add_option("FOLDER", o.folder, "Folder of the session files; need not be there yet")
      ->required();
  sub->add_option("--jobs", o.jobs, kJobsHelp);
}

}  // namespace haptrial::experiments
