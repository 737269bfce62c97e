#include <fmt/format.h>

#include "experiments/command/commands.h"
#include "experiments/studies/experiment.h"

namespace haptrial::experiments {

int validate(const std::string& file) {
  const Experiment experiment = load_experiment(file);
  fmt::print("{}: valid\n", file);
  for (const std::string& line : experiment.definition->description()) {
    fmt::print("{}\n", line);
  }
  print_warnings(experiment);
  return 0;
}

}  // namespace haptrial::experiments
