#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

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
  std::string since;  // session file, or a folder of them
};

/// The newest of a folder's sessions that can be read; pilots are no part of a study. Empty: there
/// is none.
std::string newest_session(const std::string& folder) {
  std::pair<std::string, std::string> newest;  // start, file
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".h5") {
      continue;
    }
    try {
      const record::SessionInfo info = record::SessionReader(entry.path()).info();
      if (!info.pilot) {
        newest = std::max(newest, {info.start_utc, entry.path().string()});
      }
    } catch (const InputError&) {
      continue;  // analyze and roster name it
    }
  }
  return newest.second;
}

/// Lines that name the keys in which a session's definition differs.
/// @param since  session file, or a folder whose newest session is meant
/// @throws InputError for a file that is no session of the definition's protocol
std::vector<std::string> changes_since(const Experiment& experiment, const std::string& since) {
  const std::string session = std::filesystem::is_directory(since) ? newest_session(since) : since;
  if (session.empty()) {
    return {};
  }
  const record::SessionInfo info = record::SessionReader(session).info();
  const protocols::Protocol& protocol = experiment.study->protocol();
  if (&protocol_of(info) != &protocol) {
    throw InputError(
        fmt::format("{}: a session of another protocol than the definition's", session));
  }
  const DefinitionChanges changes =
      protocols::study_changes(protocol, info, experiment.definition->text, info.device);
  std::vector<std::string> lines;
  const auto add = [&](const char* meaning, const std::vector<DefinitionChange>& of) {
    for (const DefinitionChange& each : of) {
      lines.push_back(fmt::format("since {}, {}: {}", session, meaning, sentence_of({each})));
    }
  };
  add("another study", changes.binding);
  add("may change within a study", changes.free);
  if (lines.empty()) {
    lines.push_back(fmt::format(
        "since {}: {}", session,
        changes.same_text ? "nothing has changed" : "only comments and layout have changed"));
  }
  return lines;
}

/// The definition in each of its languages. @throws InputError for texts with a mistake
std::map<std::string, Experiment> translations_of(const std::string& file) {
  std::map<std::string, Experiment> translated;
  for (const std::string& language : protocols::languages_of(file)) {
    translated.emplace(language, load_experiment(file, language));
  }
  return translated;
}

void print_lines(const std::vector<std::string>& lines) {
  for (const std::string& line : lines) {
    fmt::print("{}\n", line);
  }
}

void print_translation(const std::string& language, const Experiment& translated) {
  fmt::print("language {}: {}\n", language,
             translated.untranslated.empty() ? "complete" : "incomplete");
  for (const std::string& sentence : translated.untranslated) {
    fmt::print("warning: {}\n", sentence);
  }
  print_undrawable(translated);
  print_missing_speech(*translated.definition);
}

int validate(const ValidateOptions& options) {
  const std::string& file = options.definition;
  const Experiment experiment = load_experiment(file);
  const std::map<std::string, Experiment> translated = translations_of(file);
  const std::vector<std::string> changes =
      options.since.empty() ? std::vector<std::string>() : changes_since(experiment, options.since);
  fmt::print("{}: valid\n", file);  // nothing is refused from here on
  print_lines(changes);
  if (const std::string& lab = experiment.definition->lab; !lab.empty()) {
    fmt::print("lab file: {}\n", lab);
  }
  print_lines(experiment.definition->description());
  const protocols::Definition& definition = *experiment.definition;
  if (const auto* trials = dynamic_cast<const protocols::TrialsDefinition*>(&definition)) {
    print_lines(protocols::costs_of_bodies(*trials));
  }
  for (const auto& side : experiment.study->protocol().auxiliary_pages(definition)) {
    fmt::print("page beside the console: {} (haptrial run --console --side-page {})\n",
               side->title(), side->name());
  }
  print_warnings(experiment);
  print_undrawable(experiment);
  print_missing_speech(definition);
  for (const auto& [language, experiment_in_it] : translated) {
    print_translation(language, experiment_in_it);
  }
  return 0;
}

}  // namespace

void add_validate(CLI::App& app, int& status) {
  CLI::App* sub = subcommand(app, "validate", "Check a definition and show the study that it plans",
                             "haptrial validate first_experiment", {"", "guide-experimenter.md"});
  auto& o = options_of<ValidateOptions>(*sub, status, validate);
  sub->add_option("DEFINITION", o.definition, "Experiment definition (.toml)")->required();
  sub->add_option(
      "--since", o.since,
      "Session file (.h5), or folder of which the newest session of the study is meant: "
      "name each key that has changed since, and whether it may within a study");
}

}  // namespace haptrial::experiments
