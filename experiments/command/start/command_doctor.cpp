#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <optional>

#include "experiments/command/start/examples.h"
#include "experiments/command/start/machine_checks.h"
#include "experiments/command/start/touch_checks.h"
#include "experiments/command/subcommand.h"
#include "experiments/studies/experiment.h"

namespace haptrial::experiments {
namespace {

struct DoctorOptions {
  std::string where{"."};
};

constexpr double kClockSeconds = 2.0;
constexpr double kUsualRate = 1000.0;  // [Hz]

const char* word_of(MachineCheck::State state) {
  switch (state) {
    case MachineCheck::State::kReady:
      return "ready";
    case MachineCheck::State::kLimited:
      return "limited";
    case MachineCheck::State::kAbsent:
      return "absent";
    case MachineCheck::State::kUnused:
      return "unused";
    case MachineCheck::State::kBroken:
      break;
  }
  return "BROKEN";
}

/// Marks what sessions of a definition do without.
void mark_unused(const protocols::Definition& definition, std::vector<MachineCheck>& checks) {
  for (MachineCheck& check : checks) {
    const bool sound = check.what == "sound" && !definition.is_heard();
    const bool beside = check.what == "video" || check.what == "stream";  // asked for by options
    if ((sound || beside) && check.state != MachineCheck::State::kReady) {
      check.state = MachineCheck::State::kUnused;
    }
  }
}

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
  const std::string folder = experiment ? "." : where;
  const double rate = experiment ? experiment->definition->rate : kUsualRate;
  std::vector<MachineCheck> checks{check_clock(kClockSeconds, rate),
                                   check_real_time(),
                                   check_off_screen(),
                                   check_window(),
                                   check_sound(),
                                   check_video(),
                                   check_stream(),
                                   check_disk(folder)};
  for (MachineCheck& device : check_devices()) {
    checks.push_back(std::move(device));
  }
  const TouchSearch here = this_machine(
      experiment ? std::optional(experiment->definition->vendor.open_haptics.name) : std::nullopt);
  for (MachineCheck& touch : check_touch(here)) {
    checks.push_back(std::move(touch));
  }
  if (experiment) {
    mark_unused(*experiment->definition, checks);
  }
  std::ranges::stable_sort(checks, {}, &MachineCheck::state);  // what asks for something first
  for (const MachineCheck& check : checks) {
    fmt::print("{:<15}  {:<7}  {}\n", check.what, word_of(check.state), check.found);
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
