#pragma once

#include <limits>

namespace haptrial {

/// Inclusive bounds of a number in a definition.
struct Bounds {
  double low{-std::numeric_limits<double>::infinity()};
  double high{std::numeric_limits<double>::infinity()};
  bool open_low{false};  // low itself is not allowed
};

inline constexpr Bounds kPositive{0.0, std::numeric_limits<double>::infinity(), true};
inline constexpr Bounds kNonNegative{0.0, std::numeric_limits<double>::infinity(), false};
inline constexpr Bounds kFraction{0.0, 1.0, false};

}  // namespace haptrial
