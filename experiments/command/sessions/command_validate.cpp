#include <fmt/format.h>

#include "experiments/command/sessions/session_commands.h"
#include "experiments/studies/experiment.h"
#include "protocols/definition/languages.h"

namespace haptrial::experiments {
namespace {

void print_undrawable(const Experiment& experiment) {
  for (const std::string& sentence : undrawable_texts(experiment)) {
    fmt::print("warning: {}\n", sentence);
  }
}

}  // namespace

int validate(const std::string& file) {
  const Experiment experiment = load_experiment(file);
  fmt::print("{}: valid\n", file);
  if (const std::string& lab = experiment.definition->lab; !lab.empty()) {
    fmt::print("lab file: {}\n", lab);
  }
  for (const std::string& line : experiment.definition->description()) {
    fmt::print("{}\n", line);
  }
  const protocols::Definition& definition = *experiment.definition;
  for (const auto& side : experiment.study->protocol().auxiliary_pages(definition)) {
    fmt::print("page beside the console: {} (haptrial run --console --side-page {})\n",
               side->title(), side->name());
  }
  print_warnings(experiment);
  print_undrawable(experiment);
  for (const std::string& language : protocols::languages_of(file)) {
    const Experiment translated = load_experiment(file, language);
    fmt::print("language {}: {}\n", language,
               translated.untranslated.empty() ? "complete" : "incomplete");
    for (const std::string& sentence : translated.untranslated) {
      fmt::print("{}\n", sentence);
    }
    print_undrawable(translated);
  }
  return 0;
}

}  // namespace haptrial::experiments
