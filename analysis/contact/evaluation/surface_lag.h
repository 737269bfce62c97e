#pragma once

#include <Eigen/Core>
#include <vector>

#include "analysis/contact/recording/stream_lag.h"

namespace haptrial::evaluation {

/// Direction of a force according to a known body, at the poses' times.
struct SurfaceWay {
  std::vector<double> time;               // (n) increasing [s]
  std::vector<Eigen::Vector3d> normal;    // (n) unit length, frame W
  std::vector<Eigen::Vector3d> velocity;  // (n) of the probe in W [m/s]
  std::vector<bool> touching;  // (n) the probe is and stays on the body; others are left out
};

/// The lag between poses and forces once the body is known: at each lag the direction of the force
/// is explained, by least squares, as a n - b v/|v| (normal and friction), whatever its size. The
/// lag is the one that leaves least; its interval comes from leaving out one of ten blocks at a
/// time, and is never narrower than a step. A hand that presses as it likes does not disturb it,
/// and it needs no change of position along the force, which estimate_lag() does.
///
/// Doubted where it leaves more than 0.9 of what the median lag leaves, where the best lag is the
/// largest that was tried, or where the interval is wider than `largest`. A lag changes the
/// friction that fits best, by `as_friction`, since a probe that moves on over a body turns the
/// normal into its direction of movement. The two look alike where their effects correlate beyond
/// 0.95: as when it goes round an axis with an even speed.
/// @param force  in W; samples are used whose size is above `least_force` > 0 [N]
/// @param options  `slowest` is not used
/// @throws std::invalid_argument for a bad stream or option, lengths that differ or fewer than 100
/// samples with a force.
LagFit estimate_surface_lag(const SurfaceWay& way, const ForceStream& force, double least_force,
                            const LagOptions& options = {});

}  // namespace haptrial::evaluation
