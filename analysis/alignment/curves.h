#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace haptrial::analysis {

/// A force curve and its slope on a common time base. Views only: the caller owns the samples.
struct CurveView {
  std::span<const double> force;  // (samples) [N]
  std::span<const double> slope;  // (samples) [N/s]
};

/// The most samples of one curve.
inline constexpr std::size_t kMostAlignmentSamples = 32768;

struct AlignmentPair {
  CurveView target;
  CurveView applied;
};

struct PathPoint {
  std::uint32_t target{0};   // i
  std::uint32_t applied{0};  // j
  bool operator==(const PathPoint&) const = default;
};

struct Alignment {
  double cost{0.0};             // sum of weighted e along the path, and of the penalties [1]
  double weight{0.0};           // sum of the weights of e; path.size() in the published form
  std::vector<PathPoint> path;  // from (0,0) to (N-1,M-1) unless an end is open
};

}  // namespace haptrial::analysis
