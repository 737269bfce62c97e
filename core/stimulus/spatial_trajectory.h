#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/base/definition/schema_forward.h"
#include "core/base/point_state.h"

namespace haptrial {
class RandomStream;
}

namespace haptrial::stimulus {

/// How the spatial trajectories of a study are drawn. Source: Morris 2006, §4.2.3.
struct TrajectoryParameters {
  double length_x{0.10};                  // extent from left to right > 0 [m]
  double range_z{0.06};                   // extent of z after scaling > 0 [m]
  int sinusoids{20};                      // number summed >= 1
  double max_spatial_frequency{30.0};     // of each sinusoid >= 0.1 [cycles/m]
  double speed{0.016};                    // along the arc > 0 [m/s]
  std::string from{};                     // a recorded pass in place of the above, FILE.h5:TRIAL
  std::vector<Eigen::Vector3d> points{};  // its path, once it is read // (N x 3) [m]
};

/// The keys of [trajectory].
const Schema<TrajectoryParameters>& trajectory_schema();

/// A curve in the xz plane, travelled at constant speed along its arc:
///
///     z(x) = scaled sum over i of sin(2 pi f_i x + phi_i) + c_i,   y = 0
///
/// centred on the device's origin. Stored at equal steps of arc length, linear in between.
/// Source: Morris 2006, §4.2.3 (the speed is tangential: docs/algorithms/stimuli.md).
class SpatialTrajectory {
 public:
  /// A random trajectory; draws from `random` only.
  SpatialTrajectory(const TrajectoryParameters& parameters, RandomStream& random);
  /// The polyline through `points` ((N x 3) [m], N >= 2, total length > 0), travelled at `speed`.
  /// @throws std::invalid_argument when the points do not span a curve.
  SpatialTrajectory(const std::vector<Eigen::Vector3d>& points, double speed);

  double length() const noexcept { return length_; }             // arc length [m]
  double speed() const noexcept { return speed_; }               // [m/s]
  double duration() const noexcept { return length_ / speed_; }  // of one pass [s]

  /// State of the ideal tool `time` seconds after the start of the pass; it rests at both ends.
  /// Servo thread.
  PointState at(double time) const noexcept;

  /// The stored points, equally spaced along the arc. // (N x 3) [m]
  const std::vector<Eigen::Vector3d>& points() const noexcept { return points_; }

 private:
  void resample(const std::vector<Eigen::Vector3d>& polyline);

  std::vector<Eigen::Vector3d> points_;
  double length_{0.0};
  double speed_{0.0};
};

}  // namespace haptrial::stimulus
