#pragma once

#include <stdexcept>

namespace haptrial {

/// @throws std::invalid_argument with `sentence`, which names the parameter, unless `good`.
inline void require(bool good, const char* sentence) {
  if (!good) {
    throw std::invalid_argument(sentence);
  }
}

}  // namespace haptrial
