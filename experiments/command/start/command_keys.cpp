#include <fmt/format.h>

#include "experiments/command/start/key_commands.h"
#include "experiments/command/start/key_list.h"

namespace haptrial::experiments {

int keys(const std::string& word) {
  const bool all = word.empty() || is_protocol(word);
  fmt::print("{}", all ? key_page(key_sections(word)) : found_keys(sections_with(word)));
  return 0;
}

}  // namespace haptrial::experiments
