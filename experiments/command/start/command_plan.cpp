#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>

#include "core/base/error.h"
#include "experiments/command/subcommand.h"
#include "experiments/plan/audit/preregistration.h"

namespace haptrial::experiments {
namespace {

namespace fs = std::filesystem;

struct PlanOptions {
  std::string definition;
  std::string out;
  std::string power;
};

/// The plan's file: beside the definition, or of its name in another folder.
fs::path plan_file(const PlanOptions& options) {
  const fs::path beside = plan_beside(options.definition);
  if (options.out.empty()) {
    return beside;
  }
  std::error_code error;
  fs::create_directories(options.out, error);
  if (error) {
    throw InputError(
        fmt::format("{}: the folder cannot be created ({})", options.out, error.message()));
  }
  return fs::path(options.out) / beside.filename();
}

int plan(const PlanOptions& options) {
  const Experiment experiment = load_experiment(options.definition);
  const fs::path file = plan_file(options);
  const bool written =
      write_plan(make_plan(experiment, options.power), file, experiment.definition->description());
  const StudyPlan there = read_study_plan(file);
  fmt::print("{}: {}\n", written ? "plan" : "the same plan is there already", file.string());
  fmt::print("document: {}\n", fs::path(file).replace_extension(".html").string());
  fmt::print("made at {}, SHA-256 {}\n", there.made_utc, there.sha256);
  if (const std::string over = retention_sentence(there, utc_now().substr(0, 10)); !over.empty()) {
    fmt::print("{}\n", over);
  }
  if (written) {
    fmt::print(
        "Deposit the document or its SHA-256 where others see the date; from now on sessions name "
        "the plan, and reports say what was done otherwise.\n");
  }
  return 0;
}

}  // namespace

void add_plan(CLI::App& app, int& status) {
  CLI::App* sub = subcommand(
      app, "plan", "Write a study's preregistration, which sessions and reports then name",
      "haptrial plan first_experiment", {"NAME.plan.json, .html and .md, once", "guide-plan.md"});
  auto& o = options_of<PlanOptions>(*sub, status, plan);
  sub->add_option("DEFINITION", o.definition, "Experiment definition (.toml)")->required();
  sub->add_option("--out", o.out,
                  "Folder for the plan, such as that of the sessions (default: that of the "
                  "definition)");
  sub->add_option("--power", o.power,
                  "Folder that haptrial power simulate wrote: its power stands in the plan");
}

}  // namespace haptrial::experiments
