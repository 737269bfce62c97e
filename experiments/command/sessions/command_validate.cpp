#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "core/base/error.h"
#include "core/record/read/session_reader.h"
#include "experiments/command/subcommand.h"
#include "experiments/screen/speech_library.h"
#include "experiments/studies/experiment.h"
#include "experiments/studies/registry.h"
#include "protocols/definition/languages.h"
#include "protocols/definition/speech_options.h"
#include "protocols/interface/protocol.h"
#include "protocols/interface/study_rules.h"
#include "protocols/psychophysics/definition/every_value.h"
#include "protocols/psychophysics/definition/trials_definition.h"

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

struct ValidateOptions {
  std::string definition;
  std::string since;  // session file
};

/// Prints the keys in which a session's definition differs, a line each.
void print_changes(const Experiment& experiment, const std::string& session) {
  const record::SessionInfo info = record::SessionReader(session).info();
  const protocols::Protocol& protocol = experiment.study->protocol();
  if (&protocol_of(info) != &protocol) {
    throw InputError(
        fmt::format("{}: a session of another protocol than the definition's", session));
  }
  const DefinitionChanges changes =
      protocols::study_changes(protocol, info, experiment.definition->text, info.device);
  const auto print = [&session](const char* meaning, const std::vector<DefinitionChange>& of) {
    for (const DefinitionChange& each : of) {
      fmt::print("since {}, {}: {}\n", session, meaning, sentence_of({each}));
    }
  };
  print("another study", changes.binding);
  print("may change within a study", changes.free);
  if (changes.binding.empty() && changes.free.empty()) {
    fmt::print("since {}: {}\n", session,
               changes.same_text ? "nothing has changed" : "only comments and layout have changed");
  }
}

int validate(const ValidateOptions& options) {
  const std::string& file = options.definition;
  const Experiment experiment = load_experiment(file);
  fmt::print("{}: valid\n", file);
  if (!options.since.empty()) {
    print_changes(experiment, options.since);
  }
  if (const std::string& lab = experiment.definition->lab; !lab.empty()) {
    fmt::print("lab file: {}\n", lab);
  }
  for (const std::string& line : experiment.definition->description()) {
    fmt::print("{}\n", line);
  }
  const protocols::Definition& definition = *experiment.definition;
  if (const auto* trials = dynamic_cast<const protocols::TrialsDefinition*>(&definition)) {
    for (const std::string& line : protocols::costs_of_bodies(*trials)) {
      fmt::print("{}\n", line);
    }
  }
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
  auto& o = options_of<ValidateOptions>(*sub, status, validate);
  sub->add_option("DEFINITION", o.definition, "Experiment definition (.toml)")->required();
  sub->add_option("--since", o.since,
                  "Session file (.h5): name each key that has changed since, and whether it may "
                  "within a study");
}

}  // namespace haptrial::experiments
