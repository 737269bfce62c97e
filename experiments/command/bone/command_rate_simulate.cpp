#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>

#include "analysis/files/staging.h"
#include "core/base/error.h"
#include "core/bone/record/drilling_tables.h"
#include "core/record/read/session_reader.h"
#include "experiments/command/arguments.h"
#include "experiments/command/subcommand.h"
#include "experiments/control/signals.h"
#include "experiments/studies/drilling/drilling_study.h"
#include "experiments/studies/drilling/simulated_rater.h"
#include "experiments/study/study_files.h"

namespace haptrial::experiments {
namespace {

struct RateSimulateOptions {
  std::string folder;
  std::optional<int> jobs;
  bool overwrite{false};
};

int rate_simulate(const RateSimulateOptions& options) {
  namespace fs = std::filesystem;
  watch_for_interrupt();
  const int jobs = checked_jobs(options.jobs);
  const fs::path study(options.folder);
  for (const fs::path& file : files_of(study, Pilots::kLeftOut)) {
    const record::SessionReader session(file);
    if (!record::drills(session)) {
      throw InputError(
          fmt::format("{}: is not a drilling session; choose a folder of sessions with "
                      "protocol = \"bone_drilling\"",
                      file.string()));
    }
    if (!session.info().simulated) {
      throw InputError(fmt::format(
          "{}: is the session of a person; simulated raters score simulated sessions only",
          file.string()));
    }
  }
  if (fs::exists(study / kRatingsFile) && !options.overwrite) {
    throw InputError(
        fmt::format("{}: exists already; choose a study without ratings or add --overwrite",
                    (study / kRatingsFile).string()));
  }
  const auto ratings = simulate_ratings(study, jobs);
  const analysis::Staging staging(study);
  staging.write(kRatingsFile, analysis::drilling::ratings_csv(ratings));
  staging.publish();
  fmt::print("{} simulated ratings by {} raters: {}\n", ratings.size(), simulated_raters().size(),
             (study / kRatingsFile).string());
  return 0;
}

}  // namespace

void add_rate_simulate(CLI::App& rate, int& status) {
  CLI::App* sub = subcommand(
      rate, "simulate", "Score a dry run with two simulated raters, who follow the written rubric",
      "haptrial rate simulate out/construct_validity-001");
  auto& o = options_of<RateSimulateOptions>(*sub, status, rate_simulate);
  sub->add_option("DIR", o.folder, "Folder of drilling sessions (.h5)")->required();
  sub->add_flag("--overwrite", o.overwrite, "Overwrite existing ratings");
  sub->add_option("--jobs", o.jobs, kJobsHelp);
}

}  // namespace haptrial::experiments
