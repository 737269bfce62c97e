#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "analysis/reaching/reach.h"

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

struct MetricOptions {
  MovementOptions movement;
  Eigen::Vector3d normal{0.0, 1.0, 0.0};  // of the plane of the movement, towards the onlooker
  double target_radius{0.01};             // an end farther from the target missed it, > 0 [m]
  double direction_after{0.15};           // the direction is read so long after onset, > 0 [s]
};

/// Warnings that a reader should know before trusting the metrics; all false for a sound reach.
struct ReachFlags {
  bool not_finite{false};       // a sample is not finite: nothing is defined
  bool no_onset{false};         // never faster than onset_speed after the go signal
  bool moving_at_start{false};  // not at rest before the movement: no onset either
  bool anticipated{false};      // the onset lies before the go signal: reaction time below 0
  bool never_slowed{false};     // no end; path, area and force are taken to the last sample
  bool missed_target{false};    // ended farther from the target than target_radius
  bool sound() const {
    return !(not_finite || no_onset || moving_at_start || anticipated || never_slowed ||
             missed_target);
  }
};

/// Lateral is positive to the left of the way from start to target (WayFrame). Nothing where a
/// metric is not defined: all without an onset, those marked "end" without an end, those marked
/// "force" without forces.
struct ReachMetrics {
  ReachFlags flags;
  std::optional<double> onset;                        // as Reach::time [s]
  std::optional<double> end;                          // end; as Reach::time [s]
  std::optional<double> reaction_time;                // from go to onset [s]
  std::optional<double> movement_time;                // end; from onset to end [s]
  std::optional<double> peak_speed;                   // [m/s]
  std::optional<double> time_to_peak;                 // from onset [s]
  std::optional<double> path_length;                  // from onset to end [m]
  std::optional<double> maximum_perpendicular_error;  // the farthest from the line, signed [m]
  std::optional<double> signed_area;         // between path and line, left minus right [m²]
  std::optional<double> direction_error;     // from the way to the displacement since onset [rad]
  std::optional<double> endpoint_error;      // end; distance from the target [m]
  std::optional<double> endpoint_extent;     // end; beyond the target, along the way [m]
  std::optional<double> mean_lateral_force;  // force; over the movement's time [N]
  std::optional<double> peak_lateral_force;  // force; the largest, signed [N]
};

/// The line is the straight one from start to target. The area is ∫ lateral d(along) between onset
/// and end: that of a path which turns back on itself counts with its sign.
/// @throws std::invalid_argument as check_reach and WayFrame, and naming the option that breaks its
/// bound.
ReachMetrics reach_metrics(const Reach& reach, const MetricOptions& options = {});

/// How far left of the line the hand is, a time after onset [m]. Nothing without an onset or
/// outside of the recording.
std::optional<double> perpendicular_error_at(const Reach& reach, const ReachMetrics& metrics,
                                             double after_onset,
                                             const Eigen::Vector3d& normal = {0.0, 1.0, 0.0});

}  // namespace haptrial::analysis
