#pragma once

#include <cmath>

namespace haptrial::record {

/// The nearest multiple of `resolution` (a power of two), as the 32-bit columns of a session file
/// keep it: rounding again changes nothing. Adding and subtracting 1.5 * 2^52 rounds to a whole
/// number without a call, so that loops vectorise. NaN and infinity stay.
inline double on_grid(double value, double resolution) noexcept {
  constexpr double kMagic = 0x1.8p52;
  const double steps = value / resolution;
  const double rounded = (steps + kMagic) - kMagic;
  return std::abs(steps) < 0x1p51 ? rounded * resolution : value;
}

}  // namespace haptrial::record
