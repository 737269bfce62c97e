#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

namespace haptrial::evaluation {

/// Poses of a probe P over time, in the frame W of its tracker.
struct PoseStream {
  std::vector<double> time;                     // (n) increasing [s]
  std::vector<Eigen::Vector3d> position;        // (n) p_WP [m]
  std::vector<Eigen::Quaterniond> orientation;  // (n) R_WP, unit length

  std::size_t size() const { return time.size(); }
};

/// Readings of a force sensor S over time.
struct ForceStream {
  std::vector<double> time;             // (n) increasing [s]
  std::vector<Eigen::Vector3d> force;   // (n) in S [N]
  std::vector<Eigen::Vector3d> torque;  // (n) in S about its origin [N·m]; or none

  std::size_t size() const { return time.size(); }
};

/// A contact as recorded: two streams at rates of their own.
struct ContactRecording {
  PoseStream pose;
  ForceStream force;
  /// (n, as pose) how far the tool was behind its pose, where poses are places on the surface; or
  /// none, where they are the tool's [m].
  std::vector<double> depth;
};

/// @throws std::invalid_argument naming what is wrong: lengths that differ, fewer than two samples,
/// times that do not increase, a value that is not finite, an orientation that has no unit length.
void check(const PoseStream& pose);
void check(const ForceStream& force);

/// The samples at which the pose changed (the first is one): recordings with a row for every event
/// repeat the last known pose. If a pose stays for more than three times the median time between
/// changes it was read again, and the last sample that says so is kept as well: at the stream's
/// end, or half that time before the next change.
PoseStream changes(const PoseStream& pose);
/// The same for force and torque.
ForceStream changes(const ForceStream& force);

/// Poses between the samples: positions linearly, orientations at constant angular velocity; held
/// at the ends.
/// @param times  increasing [s]
/// @throws std::invalid_argument as check(), and when times do not increase.
PoseStream resampled(const PoseStream& pose, std::span<const double> times);

/// Forces and torques at other times: the mean of the straight lines between samples over
/// `width` seconds around each time; 0: the value at that time. Held at the ends. A width of one
/// over the new rate keeps most of what the new rate cannot show from being folded into it.
/// @param times  increasing [s]
/// @throws std::invalid_argument as check(), when times do not increase or the width is negative.
ForceStream resampled(const ForceStream& force, std::span<const double> times, double width);

/// Times `step` apart from `first` to at most `last`. @throws std::invalid_argument unless
/// step > 0, first <= last and there are fewer than 1e9.
std::vector<double> even_times(double first, double last, double step);

}  // namespace haptrial::evaluation
