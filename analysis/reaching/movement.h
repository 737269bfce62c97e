#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

namespace haptrial::analysis {

/// Criteria of a movement.
///
/// Onset: from the first sample after the go signal that is faster than `search_from` of the peak
/// speed, back to where the speed last rose above `onset_speed`. A twitch before the reach does not
/// count, and the start is not missed by the time that a reach needs to become fast. The search
/// back from a tenth of the peak speed is that of Teasdale et al. 1993, Journal of Motor Behavior
/// 25, 97; with 0 the onset is the first rise above `onset_speed`.
///
/// End: the first fall below `end_speed` after the peak that lasts `end_hold`, or to the end of the
/// recording where that comes sooner. A reach that stops short and is corrected ends after the
/// correction.
struct MovementOptions {
  double onset_speed{0.03};  // > 0 [m/s]
  double search_from{0.1};   // share of the peak speed, in [0, 1)
  double end_speed{0.05};    // > 0 [m/s]
  double end_hold{0.1};      // >= 0 [s]
};

struct Movement {
  std::optional<double> onset;      // interpolated between samples, as `time` [s]
  std::optional<double> end;        // the same
  std::optional<double> peak_time;  // where there is an onset
  double peak_speed{0.0};           // after the go signal [m/s]
  bool moving_at_start{false};      // no onset: the hand is never at rest before it is fast
};

/// @param time      (n) rising [s]; it ends before the hand is led back.
/// @param velocity  (n) finite [m/s].
/// @throws std::invalid_argument naming the option that breaks its bound.
Movement find_movement(std::span<const double> time, std::span<const Eigen::Vector3d> velocity,
                       double go, const MovementOptions& options = {});

}  // namespace haptrial::analysis
