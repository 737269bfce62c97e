#pragma once

#include <Eigen/Core>

#include "core/base/point_state.h"

namespace haptrial::control {

/// A straight move from rest to rest with the least jerk (Flash and Hogan 1985):
///
///     p(t) = a + (b - a) (10 u^3 - 15 u^4 + 6 u^5),  u = t / T
///
/// T follows from the peak speed, 15/8 of the mean. Servo thread.
class MinimumJerkMove {
 public:
  MinimumJerkMove() = default;  // already there: stays at the origin
  /// @param from, to    [m]
  /// @param peak_speed  > 0 [m/s]
  MinimumJerkMove(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                  double peak_speed) noexcept;

  PointState at(double time) const noexcept;              // time since the start [s]
  double duration() const noexcept { return duration_; }  // [s]

 private:
  Eigen::Vector3d from_{Eigen::Vector3d::Zero()};
  Eigen::Vector3d to_{Eigen::Vector3d::Zero()};
  double duration_{0.0};
};

}  // namespace haptrial::control
