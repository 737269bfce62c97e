#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <vector>

#include "analysis/alignment/alignment.h"
#include "core/base/random.h"

namespace haptrial::test {}

namespace haptrial::analysis::test {

using namespace haptrial::test;  // helpers of all tests, beside those of this folder

/// A curve that owns its samples.
struct Curve {
  std::vector<double> force, slope;
  CurveView view() const { return {force, slope}; }
};

/// Multiples of 1/64: every sum and product of the search is exact in single precision, so that a
/// search in any precision must find the same path and cost.
inline Curve exact_curve(RandomStream& random, std::size_t samples) {
  Curve curve;
  for (std::size_t i = 0; i < samples; ++i) {
    curve.force.push_back(static_cast<double>(random.below(512)) / 64.0);
    curve.slope.push_back(static_cast<double>(random.below(512)) / 64.0 - 4.0);
  }
  return curve;
}

/// A smooth curve with noise, as forces come.
inline Curve smooth_curve(RandomStream& random, std::size_t samples) {
  Curve curve;
  const double phase = random.uniform(0.0, 6.0), pitch = random.uniform(6.0, 18.0);
  for (std::size_t i = 0; i < samples; ++i) {
    const double angle = phase + pitch * static_cast<double>(i) / static_cast<double>(samples);
    curve.force.push_back(5.0 + 4.0 * std::sin(angle) + 0.1 * random.normal());
    curve.slope.push_back(3.0 * std::cos(angle) + 0.1 * random.normal());
  }
  return curve;
}

inline const AlignmentOptions kExact{.force_weight = 1.0, .slope_weight = 0.25, .penalty = 0.5};

/// The recurrence as a textbook has it: the whole matrix, then back from its last entry.
template <class Real>
std::vector<PathPoint> textbook_path(const Curve& a, const Curve& b, const AlignmentOptions& p) {
  const std::size_t rows = a.force.size(), columns = b.force.size();
  const Real infinity = std::numeric_limits<Real>::infinity();
  std::vector<Real> cost((rows + 1) * (columns + 1), infinity);  // row and column 0 are outside
  const auto at = [&](std::size_t i, std::size_t j) -> Real& {
    return cost[i * (columns + 1) + j];
  };
  const auto scaled = [&](double weight, double value) {
    return static_cast<Real>((p.power == 1 ? weight : std::sqrt(weight)) * value);
  };
  const auto power = [&](Real x) { return p.power == 1 ? std::abs(x) : x * x; };
  const Real penalty = static_cast<Real>(p.penalty);
  at(0, 0) = 0;
  for (std::size_t i = 1; i <= rows; ++i) {
    for (std::size_t j = 1; j <= columns; ++j) {
      const Real error =
          power(scaled(p.force_weight, a.force[i - 1]) - scaled(p.force_weight, b.force[j - 1])) +
          power(scaled(p.slope_weight, a.slope[i - 1]) - scaled(p.slope_weight, b.slope[j - 1]));
      at(i, j) = error + std::min(at(i - 1, j - 1), std::min(at(i - 1, j), at(i, j - 1)) + penalty);
    }
  }
  std::vector<PathPoint> path;
  for (std::size_t i = rows, j = columns;;) {
    path.push_back({static_cast<std::uint32_t>(i - 1), static_cast<std::uint32_t>(j - 1)});
    if (i == 1 && j == 1) {
      break;
    }
    const Real up = at(i - 1, j), left = at(i, j - 1);
    const bool aside = std::min(up, left) + penalty < at(i - 1, j - 1);
    const bool leftwards = aside && left < up;
    if (!leftwards) {
      --i;
    }
    if (!aside || leftwards) {
      --j;
    }
  }
  std::reverse(path.begin(), path.end());
  return path;
}

}  // namespace haptrial::analysis::test
