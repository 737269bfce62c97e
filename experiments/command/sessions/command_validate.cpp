#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "core/base/error.h"
#include "experiments/command/subcommand.h"
#include "experiments/screen/speech_library.h"
#include "experiments/studies/experiment.h"
#include "protocols/definition/languages.h"
#include "protocols/definition/speech_options.h"

namespace haptrial::experiments {
namespace {

void print_undrawable(const Experiment& experiment) {
  for (const std::string& sentence : undrawable_texts(experiment)) {
    fmt::print("warning: {}\n", sentence);
  }
}

/// Says why this machine could not speak the definition.
void print_missing_speech(const protocols::Definition& definition) {
  const protocols::SpeechOptions options = protocols::speech_of(definition);
  if (!options.spoken) {
    return;
  }
  try {
    const SpeechLibrary library(options.voice);
  } catch (const InputError& error) {
    fmt::print("warning: {}\n", error.what());
  }
}

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
  print_missing_speech(definition);
  for (const std::string& language : protocols::languages_of(file)) {
    const Experiment translated = load_experiment(file, language);
    fmt::print("language {}: {}\n", language,
               translated.untranslated.empty() ? "complete" : "incomplete");
    for (const std::string& sentence : translated.untranslated) {
      fmt::print("{}\n", sentence);
    }
    print_undrawable(translated);
    print_missing_speech(*translated.definition);
  }
  return 0;
}

}  // namespace

void add_validate(CLI::App& app, int& status) {
  CLI::App* sub = subcommand(app, "validate", "Check a definition and show the study that it plans",
                             "haptrial validate first_experiment", {"", "guide-experimenter.md"});
  auto& definition = options_of<std::string>(*sub, status, validate);
  sub->add_option("DEFINITION", definition, "Experiment definition (.toml)")->required();
}

}  // namespace haptrial::experiments
