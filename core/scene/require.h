#pragma once

#include <stdexcept>
#include <string>

namespace haptrial::scene {

/// @throws std::invalid_argument with `sentence`, which names the parameter, unless `good`.
inline void require(bool good, const char* sentence) {
  if (!good) {
    throw std::invalid_argument(sentence);
  }
}

/// A length or size that may be infinite but neither 0 nor NaN.
inline bool is_positive(double x) noexcept { return x > 0.0; }

}  // namespace haptrial::scene
