#include <fmt/format.h>

#include "experiments/command/commands.h"
#include "experiments/studies/experiment.h"

namespace haptrial::experiments {

int validate(const std::string& file) {
  const Experiment experiment = load_experiment(file);
  fmt::print("{}: valid\n", file);
  if (const std::string& lab = experiment.definition->lab; !lab.empty()) {
    fmt::print("lab file: {}\n", lab);
  }
  for (const std::string& line : experiment.definition->description()) {
    fmt::print("{}\n", line);
  }
  print_warnings(experiment);
  return 0;
}

}  // namespace haptrial::experiments
