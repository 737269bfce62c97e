#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <optional>

#include "experiments/command/start/examples.h"
#include "experiments/command/start/doctor_checks.h"
#include "experiments/command/subcommand.h"
#include "experiments/studies/experiment.h"

namespace haptrial::experiments {
namespace {

struct DoctorOptions {
  std::string where{"."};
};

/// A file of a definition, or the name of a shipped one, is no folder.
bool is_definition(const std::string& where) {
  return where.ends_with(".toml") ||
         (!std::filesystem::exists(where) &&
          std::ranges::any_of(examples(), [&](const Example& e) { return e.name == where; }));
}

/// Prints what this machine can do. @returns 0 if sessions can run, else 1.
int doctor(const DoctorOptions& options) {
  const std::string& where = options.where;
  std::optional<Experiment> experiment;
  if (is_definition(where)) {
    experiment = load_experiment(definition_or_example(where));
  }
  std::vector<MachineCheck> checks =
      doctor_checks(experiment ? experiment->definition.get() : nullptr, experiment ? "." : where);
  std::ranges::stable_sort(checks, {}, &MachineCheck::state);  // what asks for something first
  for (const MachineCheck& check : checks) {
    fmt::print("{:<15}  {:<7}  {}\n", check.what, name_of(check.state), check.found);
  }
  const auto broken =
      std::ranges::count(checks, MachineCheck::State::kBroken, &MachineCheck::state);
  const auto limited =
      std::ranges::count(checks, MachineCheck::State::kLimited, &MachineCheck::state);
  const std::string sessions =
      experiment ? "Sessions of " + experiment->definition->name : "Sessions and dry runs";
  fmt::print(
      "\n{} {}\n", sessions,
      broken > 0 ? "cannot run here before what is broken is mended."
      : limited > 0 && experiment
          ? "can run here; what is limited above is worth mending before a participant comes."
          : "can run here.");
  return broken == 0 ? 0 : 1;
}

}  // namespace

void add_doctor(CLI::App& app, int& status) {
  CLI::App* sub =
      subcommand(app, "doctor", "Check whether this machine is fit for sessions",
                 "haptrial doctor first_experiment", {"", "guide-first-participant.md"});
  auto& o = options_of<DoctorOptions>(*sub, status, doctor);
  sub->add_option("WHERE", o.where,
                  "Definition whose sessions are to run here, or folder for session files "
                  "(default: here)");
}

}  // namespace haptrial::experiments
