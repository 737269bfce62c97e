#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/error.h"
#include "experiments/command/start/key_commands.h"
#include "experiments/command/start/key_list.h"
#include "experiments/studies/registry.h"

namespace haptrial::experiments {

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

}  // namespace haptrial::experiments
