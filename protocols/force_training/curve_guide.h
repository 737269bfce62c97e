#pragma once

#include <memory>

#include "core/control/curve_constraint.h"
#include "core/stimulus/spatial_trajectory.h"

namespace haptrial::protocols {

/// Leads a hand that sets its own pace: across the path it is held, along it it is free, and how
/// far it has come follows from where it is. Source: Morris 2006, §6.1 and §6.2.
class CurveGuide {
 public:
  CurveGuide(const stimulus::SpatialTrajectory& path, const control::CurveFollowing& following);

  // Servo thread, all of them.
  void start() noexcept;  // at the path's first point
  /// @returns what a spring and damper pull the tool to: the place on the path, moving along with
  ///   the tool.
  PointState follow(const PointState& tool) noexcept;
  /// How far along the path, as the time that it takes at the path's speed [s].
  double along() const noexcept { return constraint_.place().arc / speed_; }
  const Eigen::Vector3d& direction() const noexcept { return constraint_.direction(); }
  bool at_end() const noexcept;

 private:
  double speed_;                                  // of the path [m/s]
  std::unique_ptr<control::SampledCurve> curve_;  // where the constraint expects it
  control::CurveConstraint constraint_;
};

}  // namespace haptrial::protocols
