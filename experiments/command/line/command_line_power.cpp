// Power: in closed form and by simulation.

#include "experiments/command/analysis/power_commands.h"
#include "experiments/command/line/command_lines.h"
#include "experiments/command/line/subcommand_internal.h"

namespace haptrial::experiments {
namespace {

void add_simulated_studies(CLI::App& power, int& status) {
  CLI::App* sub = subcommand(
      power, "simulate", "Simulate a study many times and count what its report finds",
      "haptrial power simulate docs/worked/power/repetition.toml --out out/repetition",
      {"parts and, once they are all there, a report, tables and a figure in the folder of --out",
       "guide-power.md"});
  auto& o = options_of<PowerSimulateOptions>(*sub, status, power_simulate);
  sub->add_option("DEFINITION", o.question,
                  "Definition with a table [power], or a file with [power] that names one (.toml)")
      ->required();
  sub->add_option("--out", o.out, "Folder of the simulation (default: out/NAME-power)");
  sub->add_option("--jobs", o.jobs, "Number of threads (default: one per processor)");
  sub->add_option("--part", o.part, "Do part I of N of the work, I/N, without a report");
  sub->add_option("--minutes", o.minutes, "Begin nothing after this time, and exit with status 0");
}

template <class Command>
void add_parts_command(CLI::App& power, const char* name, const char* what, const char* example,
                       int& status, Command command) {
  CLI::App* sub = subcommand(power, name, what, example, {"", "guide-power.md"});
  auto& folder = options_of<std::string>(*sub, status, command);
  sub->add_option("DIR", folder, "Folder of a simulation")->required();
}

void add_array_script(CLI::App& power, int& status) {
  CLI::App* sub = subcommand(
      power, "plan", "Write a batch script that simulates as a Slurm array",
      "haptrial power plan docs/worked/power/repetition.toml --out out/repetition --tasks 50",
      {"the script", "guide-power.md"});
  auto& o = options_of<PowerScriptOptions>(*sub, status, power_script);
  sub->add_option("DEFINITION", o.question, "As of haptrial power simulate (.toml)")->required();
  sub->add_option("--out", o.out, "Folder of the simulation")->required();
  sub->add_option("--tasks", o.tasks, "Number of tasks of the array (default: 100)");
  sub->add_option("--hours", o.hours, "Time limit of a task [h] (default: 1)");
  sub->add_option("--script", o.script, "File of the script (default: the folder's name, .sbatch)");
}

}  // namespace

void add_simulated_power(CLI::App& power, int& status) {
  add_simulated_studies(power, status);
  add_parts_command(power, "merge", "Make the report of a simulation whose parts are all there",
                    "haptrial power merge out/repetition", status, power_merge);
  add_parts_command(power, "status", "Print how far a simulation is",
                    "haptrial power status out/repetition", status, power_status);
  add_array_script(power, status);
}

}  // namespace haptrial::experiments
