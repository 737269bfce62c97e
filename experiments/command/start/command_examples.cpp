#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "experiments/command/start/examples.h"
#include "experiments/command/subcommand.h"
#include "experiments/studies/experiment.h"

namespace haptrial::experiments {
namespace {

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

}  // namespace

void add_examples(CLI::App& app, int& status) {
  CLI::App* sub = subcommand(app, "examples", "List the shipped definitions", "haptrial examples",
                             {"", "guide-own-experiment.md"});
  run_when_read(*sub, status, list_examples);
}

}  // namespace haptrial::experiments
