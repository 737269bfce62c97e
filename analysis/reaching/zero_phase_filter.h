#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "analysis/statistics/base/defined.h"

namespace haptrial::analysis {

/// A Butterworth low-pass that runs over the samples forwards and backwards, so that nothing is
/// delayed:
///
///     gain(f) = 1 / (1 + (√2 - 1) (tan(π f / rate) / tan(π cutoff / rate))^order)
///
/// Order and cut-off are those of both runs together: the gain at the cut-off is 1/√2.
/// Source: Winter 2009, Biomechanics and Motor Control of Human Movement.
struct ZeroPhaseFilter {
  int order{4};         // even, 2 .. 16; each run has half of it
  double cutoff{20.0};  // inside (0, rate / 2) [Hz]
};

/// The filtered samples. Beyond its ends the signal is continued by its point reflection for three
/// periods of the cut-off (as far as it is long), so that a straight line stays one.
/// @param rate  of the samples [Hz].
/// Undefined with fewer than four samples or one that is not finite.
/// @throws std::invalid_argument naming what of `filter` or `rate` breaks its bound.
Defined<std::vector<double>> filtered(std::span<const double> samples, double rate,
                                      const ZeroPhaseFilter& filter);

/// Slopes by differences of the neighbours, at the ends by those of the parabola through the last
/// three samples: exact for parabolas. @param samples  at least three.
std::vector<double> differentiated(std::span<const double> samples, double rate);

/// Filtered positions and their derivative.
struct SmoothMotion {
  std::vector<Eigen::Vector3d> position;  // (n) [m]
  std::vector<Eigen::Vector3d> velocity;  // (n) [m/s]
};

/// @param position  (n) at a constant rate [m]. Undefined and throws as filtered().
Defined<SmoothMotion> smooth_motion(std::span<const Eigen::Vector3d> position, double rate,
                                    const ZeroPhaseFilter& filter = {});

}  // namespace haptrial::analysis
