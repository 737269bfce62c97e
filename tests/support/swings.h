#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace haptrial::test {

/// Times at which a force turns round by 2 N or more [s].
inline std::vector<double> turns(std::span<const double> forces, double rate) {
  constexpr double kSwing = 2.0;  // peak to peak [N]
  enum class Direction { kUnknown, kUp, kDown } way = Direction::kUnknown;
  std::vector<double> turns;
  double low = forces.empty() ? 0.0 : forces[0];
  double high = low;
  std::size_t low_at = 0;
  std::size_t high_at = 0;
  for (std::size_t i = 0; i < forces.size(); ++i) {
    const double f = forces[i];
    if (f > high) {
      high = f;
      high_at = i;
    }
    if (f < low) {
      low = f;
      low_at = i;
    }
    const bool falls = way != Direction::kDown && high - f >= kSwing;
    const bool rises = way != Direction::kUp && f - low >= kSwing;
    if (falls || rises) {
      turns.push_back(static_cast<double>(falls ? high_at : low_at) / rate);
      way = falls ? Direction::kDown : Direction::kUp;
      low = high = f;
      low_at = high_at = i;
    }
  }
  return turns;
}

/// Seconds in the longest train of six such turns or more, at most 60 ms apart.
inline double longest_train(std::span<const double> forces, double rate) {
  constexpr double kGap = 0.06;  // [s]
  constexpr std::size_t kTurns = 6;
  const std::vector<double> at = turns(forces, rate);
  double longest = 0.0;
  std::size_t first = 0;
  for (std::size_t i = 1; i < at.size(); ++i) {
    first = at[i] - at[i - 1] > kGap ? i : first;
    longest = i - first + 1 >= kTurns ? std::max(longest, at[i] - at[first]) : longest;
  }
  return longest;
}

}  // namespace haptrial::test
