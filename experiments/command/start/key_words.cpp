#include "experiments/command/start/key_words_internal.h"

namespace haptrial::experiments {

std::string_view key_words() {
  return R"(
)";
}

}  // namespace haptrial::experiments
