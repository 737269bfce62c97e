#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>

#include "core/base/error.h"
#include "experiments/command/start/key_list.h"
#include "experiments/command/subcommand.h"
#include "experiments/studies/registry.h"

namespace haptrial::experiments {
namespace {

struct KeysOptions {
  std::string word;
  bool json_schema{false};
};

int keys(const KeysOptions& options) {
  const Study* study = find_study(options.word);
  const std::string protocol = study != nullptr ? std::string(study->protocol().name()) : "";
  if (options.json_schema) {
    if (study == nullptr) {
      throw InputError(
          fmt::format("--json-schema: {} is not a protocol; allowed: {}",
                      options.word.empty() ? "no word" : fmt::format("'{}'", options.word),
                      fmt::join(protocol_words(), ", ")));
    }
    fmt::print("{}\n", key_json_schema(keys_of(*study), protocol));
    return 0;
  }
  const bool all = options.word.empty() || study != nullptr;
  fmt::print("{}",
             all ? key_page(key_sections(protocol)) : found_keys(sections_with(options.word)));
  return 0;
}

}  // namespace

void add_keys(CLI::App& app, int& status) {
  CLI::App* sub = subcommand(app, "keys", "List the keys that a definition may have",
                             "haptrial keys stiffness", {"", "keys.md"});
  auto& o = options_of<KeysOptions>(*sub, status, keys);
  sub->add_option("WORD", o.word,
                  "Protocol whose keys are listed, or a word to search keys for (default: all "
                  "keys)");
  sub->add_flag("--json-schema", o.json_schema,
                "Print a JSON Schema of the protocol's definitions, for editors");
}

}  // namespace haptrial::experiments
