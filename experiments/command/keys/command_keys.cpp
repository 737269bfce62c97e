#include <fmt/format.h>

#include "experiments/command/keys/key_commands.h"
#include "experiments/command/keys/key_list.h"

namespace haptrial::experiments {

int keys(const std::string& protocol) {
  fmt::print("{}", key_page(key_sections(protocol)));
  return 0;
}

}  // namespace haptrial::experiments
