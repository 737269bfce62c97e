#include "experiments/command/line/command_lines.h"
#include "experiments/command/line/subcommand_internal.h"
#include "experiments/command/start/key_commands.h"
#include "experiments/command/start/start_commands.h"

namespace haptrial::experiments {

void add_examples(CLI::App& app, int& status) {
  CLI::App* sub = subcommand(app, "examples", "List the shipped definitions", "haptrial examples",
                             {"", "guide-own-experiment.md"});
  sub->callback([&status] { status = list_examples(); });
}

void add_new(CLI::App& app, int& status) {
  CLI::App* sub = subcommand(app, "new", "Begin a definition of one's own from a shipped one",
                             "haptrial new my_study.toml --from stiffness_discrimination",
                             {"FILE", "guide-own-experiment.md"});
  auto& o = options_of<NewOptions>(*sub, status, new_definition);
  sub->add_option("FILE", o.file, "The definition to be written (.toml)")->required();
  sub->add_option("--from", o.from, "One that haptrial examples lists (default: " + o.from + ")");
}

void add_texts(CLI::App& app, int& status) {
  CLI::App* sub = subcommand(app, "texts", "Begin the file of a definition's texts in a language",
                             "haptrial texts first_experiment --language ja",
                             {"DEFINITION.texts.LANGUAGE.toml, to be filled in",
                              "guide-own-experiment.md#pages-and-languages"});
  auto& o = options_of<TextsOptions>(*sub, status, write_texts);
  sub->add_option("DEFINITION", o.definition, "Experiment definition (.toml)")->required();
  sub->add_option("--language", o.language, "Language, such as ja or pt-BR")->required();
}

void add_doctor(CLI::App& app, int& status) {
  CLI::App* sub =
      subcommand(app, "doctor", "Check whether this machine is fit for sessions",
                 "haptrial doctor first_experiment", {"", "guide-first-participant.md"});
  auto& where = options_of<std::string>(*sub, status, doctor);
  where = ".";
  sub->add_option("WHERE", where,
                  "Definition whose sessions are to run here, or folder for session files "
                  "(default: here)");
}

void add_keys(CLI::App& app, int& status) {
  CLI::App* sub = subcommand(app, "keys", "List the keys that a definition may have",
                             "haptrial keys stiffness", {"", "keys.md"});
  auto& options = options_of<KeysOptions>(*sub, status, keys);
  sub->add_option("WORD", options.word,
                  "Protocol whose keys are listed, or a word to search keys for (default: all "
                  "keys)");
  sub->add_flag("--json-schema", options.json_schema,
                "Print a JSON Schema of the protocol's definitions, for editors");
}

}  // namespace haptrial::experiments
