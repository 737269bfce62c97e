#pragma once

#include <optional>
#include <string>

namespace haptrial::experiments {

struct PowerSimulateOptions {
  std::string question;  // definition with [power], or a file with [power] alone
  std::string out;       // folder of the parts and the report; empty: out/NAME-power
  std::string part;      // "2/8": of the units; empty: all
  std::optional<int> jobs;
  std::optional<double> minutes;
};
int power_simulate(const PowerSimulateOptions& options);

/// Makes the report of a folder whose parts are all there.
int power_merge(const std::string& folder);
/// Says how far a folder is.
int power_status(const std::string& folder);

struct PowerScriptOptions {
  std::string question;
  std::string out;     // folder of the simulation
  int tasks{100};      // of the array
  double hours{1.0};   // limit of a task
  std::string script;  // file; empty: FOLDER.sbatch
};
/// Writes a batch script for a Slurm array.
int power_script(const PowerScriptOptions& options);

}  // namespace haptrial::experiments
