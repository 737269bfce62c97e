#include <fmt/format.h>

#include <algorithm>

#include "experiments/command/start/examples.h"
#include "experiments/command/start/start_commands.h"
#include "experiments/studies/experiment.h"

namespace haptrial::experiments {

int list_examples() {
  std::size_t width = 0;
  for (const Example& example : examples()) {
    width = std::max(width, example.name.size());
  }
  for (const Example& example : examples()) {
    const Experiment experiment = parse_experiment(example.text, example.name);
    fmt::print("{:<{}}  {:<14}  {}\n", example.name, width, experiment.study->protocol().name(),
               what_of(example));
  }
  fmt::print("\nBegin a definition of your own from one: haptrial new FILE --from NAME\n");
  return 0;
}

}  // namespace haptrial::experiments
