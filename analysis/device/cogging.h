#pragma once

#include <vector>

namespace haptrial::analysis {

/// F ratio above which cogging counts as found in forces of a movement.
inline constexpr double kClearCogging = 30.0;

/// cosine · cos(2 pi frequency x) + sine · sin(2 pi frequency x).
struct SineOverWay {
  double cosine{0.0}, sine{0.0};  // [N]
  double frequency{0.0};          // [1/m]
};

/// The strongest sine over the way in what a model of forces leaves, of 0.4 mm to two thirds of
/// the way in period.
/// @param x     positions along one axis, at least two that differ [m]
/// @param left  force there that the model does not explain [N]
SineOverWay strongest_sine(const std::vector<double>& x, const std::vector<double>& left);

}  // namespace haptrial::analysis
