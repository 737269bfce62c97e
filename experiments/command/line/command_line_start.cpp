#include "experiments/command/keys/key_commands.h"
#include "experiments/command/line/command_lines.h"
#include "experiments/command/line/subcommand_internal.h"
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

void add_doctor(CLI::App& app, int& status) {
  CLI::App* sub = subcommand(app, "doctor", "Check whether this machine is fit for sessions",
                             "haptrial doctor", {"", "guide-first-participant.md"});
  auto& folder = options_of<std::string>(*sub, status, doctor);
  folder = ".";
  sub->add_option("FOLDER", folder, "Where session files are to go (default: here)");
}

void add_keys(CLI::App& app, int& status) {
  CLI::App* sub = subcommand(app, "keys", "List the keys that a definition may have",
                             "haptrial keys stiffness", {"", "keys.md"});
  auto& word = options_of<std::string>(*sub, status, keys);
  sub->add_option("WORD", word,
                  "Protocol whose keys are listed, or a word to search keys for (default: all "
                  "keys)");
}

}  // namespace haptrial::experiments
