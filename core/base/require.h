#pragma once

#include <stdexcept>

namespace haptrial {

/// A length or size that may be infinite but neither 0 nor NaN.
inline bool is_positive(double x) noexcept { return x > 0.0; }

/// @throws std::invalid_argument with `sentence`, which names the parameter, unless `good`.
inline void require(bool good, const char* sentence) {
  if (!good) {
    throw std::invalid_argument(sentence);
  }
}

}  // namespace haptrial
