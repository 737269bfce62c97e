#include <fmt/format.h>
#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>

#include "core/base/shell_word.h"
#include "core/base/whole_file.h"
#include "experiments/command/arguments.h"
#include "experiments/command/subcommand.h"
#include "experiments/power/power_run.h"

namespace haptrial::experiments {
namespace fs = std::filesystem;
namespace {

struct PowerPlanOptions {
  std::string question;
  std::string out;
  int tasks{100};
  double hours{1.0};
  std::string script;
};

/// The longest of a few units, each once [s].
double seconds_of_a_unit(const PowerQuestion& question, const std::vector<PowerUnit>& units) {
  double longest = 0.0;
  for (const PowerUnit* unit : {&units.front(), &units[units.size() / 2], &units.back()}) {
    PowerUnit one = *unit;
    one.count = 1;
    const auto start = std::chrono::steady_clock::now();
    static_cast<void>(simulated(question, one));
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
    longest = std::max(longest, time.count() * unit->count);
  }
  return longest;
}

/// Memory that a task may take [MB]: twice what this process took for a few units, in steps of 256.
int megabytes_of_a_task() {
  constexpr double kMargin = 2.0, kStep = 256.0, kKilobytes = 1024.0;
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  const double most = kMargin * static_cast<double>(used.ru_maxrss) / kKilobytes;
  return static_cast<int>(kStep * std::max(1.0, std::ceil(most / kStep)));
}

/// Warns of many small files, which slow a shared file system, and says which block avoids them.
void print_bundling(const PowerQuestion& question, std::size_t parts, double each) {
  constexpr std::size_t kFew = 1000;  // files that hurt nobody
  constexpr double kSeconds = 60.0;   // of computing that are worth a file
  if (parts <= kFew || each >= kSeconds) {
    return;
  }
  const int most = std::max(question.plan.replications, question.plan.null_replications);
  const double minute = std::ceil(question.plan.block * kSeconds / std::max(each, 1e-9));
  fmt::print(
      "a file for {:.2g} s of computing is a burden for a shared file system: block = {} in "
      "[power] makes fewer\n",
      each, static_cast<int>(std::min(minute, static_cast<double>(most))));
}

int power_plan(const PowerPlanOptions& options) {
  const int tasks = checked_number("--tasks", options.tasks, 1, 10'000);
  const double hours = checked_real("--hours", options.hours, 0.05, 1000.0);
  const PowerQuestion question = load_question(options.question);
  check_watched(question);
  const std::vector<PowerUnit> units = units_of(question);
  const double each = seconds_of_a_unit(question, units);
  const double all = each * static_cast<double>(units.size());
  const int minutes = static_cast<int>(std::ceil(60.0 * hours));
  // A unit that is under way when the time is over still ends before the limit.
  const double work = std::max(1.0, minutes - 2.0 - std::ceil(each / 60.0));
  const fs::path script =
      options.script.empty() ? fs::path(options.out + ".sbatch") : fs::path(options.script);
  write_whole(
      script,
      fmt::format(
          "#!/bin/bash\n"
          "# {} parts of at most {:.2g} s: about {:.2g} hours of computing.\n"
          "# Submitted again, or requeued, it does what is missing. No task needs a network.\n"
          "#SBATCH --job-name=haptrial-power\n"
          "#SBATCH --array=1-{}\n"
          "#SBATCH --ntasks=1 --cpus-per-task=1\n"
          "#SBATCH --time={}\n"
          "#SBATCH --mem={}M\n"
          "#SBATCH --requeue\n"
          "#SBATCH --signal=B:TERM@60\n"
          "exec haptrial power simulate {} --out {} --part $SLURM_ARRAY_TASK_ID/{} --jobs 1 "
          "--minutes {:g}\n",
          units.size(), each, all / 3600.0, tasks, minutes, megabytes_of_a_task(),
          shell_word(options.question), shell_word(options.out), tasks, work));
  fmt::print(
      "{} parts of about {:.2g} s, {:.2g} hours of computing, {:.2g} minutes for each of {} "
      "tasks\n",
      units.size(), each, all / 3600.0, all / tasks / 60.0, tasks);
  print_bundling(question, units.size(), each);
  fmt::print("next: sbatch {}, then haptrial power status {}\n", script.string(), options.out);
  return 0;
}

}  // namespace

void add_power_plan(CLI::App& power, int& status) {
  CLI::App* sub = subcommand(
      power, "plan", "Write a batch script that simulates as a Slurm array",
      "haptrial power plan docs/worked/power/repetition.toml --out out/repetition --tasks 50",
      {"the script", "guide-power.md"});
  auto& o = options_of<PowerPlanOptions>(*sub, status, power_plan);
  sub->add_option("DEFINITION", o.question, "As of haptrial power simulate (.toml)")->required();
  sub->add_option("--out", o.out, "Folder of the simulation")->required();
  sub->add_option("--tasks", o.tasks, with_default("Number of tasks of the array", o.tasks));
  sub->add_option("--hours", o.hours, with_default("Time limit of a task [h]", o.hours));
  sub->add_option("--script", o.script, "File of the script (default: the folder's name, .sbatch)");
}

}  // namespace haptrial::experiments
