#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "core/control/curve_constraint.h"
#include "core/control/pd_controller.h"
#include "core/scene/field_state.h"
#include "core/scene/found_end.h"
#include "core/stimulus/spatial_trajectory.h"

namespace haptrial::scene {

class PathGuide;

struct PathParameters {
  using Law = PathGuide;
  std::vector<Eigen::Vector3d> points{Eigen::Vector3d::Zero(),
                                      Eigen::Vector3d::UnitX()};  // (N x 3), N >= 2 [m]
  double duration{5.0};                                           // from end to end > 0 [s]
  control::PdGains gains{900.0, 100.0};                           // k >= 0 [N/m], b >= 0 [N·s/m]

  StiffnessBound bound() const { return {false, gains.stiffness, gains.damping}; }
  FieldTraits traits() const { return {.timed = true, .leads_to = points.back()}; }
};

/// Guides the hand along a path: a spring and damper to a point that travels the lines between
/// `points` at constant speed, then rests at the last one. The damper acts on the mean of the
/// point's velocity over 80 ms, which makes no step at the ends and at corners. Active. Source:
/// Morris 2006, §4.2.4.
class PathGuide {
 public:
  /// @throws std::invalid_argument naming the parameter that breaks its bound
  PathGuide(const PathParameters& parameters, const Setting& setting);
  Eigen::Vector3d force(const Felt& felt, FieldState& state) noexcept;

 private:
  Eigen::Vector3d mean_velocity(double time) const noexcept;

  stimulus::SpatialTrajectory path_;
  control::PdController controller_;
};

class CurveHold;

struct CurveParameters {
  using Law = CurveHold;
  std::vector<Eigen::Vector3d> points{Eigen::Vector3d::Zero(),
                                      Eigen::Vector3d::UnitX()};  // (N x 3), N >= 2 [m]
  control::PdGains gains{900.0, 10.0};                            // k >= 0 [N/m], b >= 0 [N·s/m]

  StiffnessBound bound() const { return {true, gains.stiffness, gains.damping}; }
  FieldTraits traits() const { return {}; }
};

/// Holds the hand on a curve through `points` and leaves it free along it, at its own pace: a
/// virtual fixture (core/control/curve_constraint.h). Where the place on the curve jumps, inside of
/// a corner, the force follows by degrees (FoundEnd). Passive. Source: Morris 2006, §6.2.
class CurveHold {
 public:
  /// @throws std::invalid_argument naming the parameter that breaks its bound
  CurveHold(const CurveParameters& parameters, const Setting& setting);

  void start(const PointState& hand) noexcept {
    constraint_->start(hand.position);
    end_.start();
  }
  /// Goes on at the place of `before`, where the two curves are the same; else at the nearest one.
  void adopt(const CurveHold& before) noexcept;
  Eigen::Vector3d force(const Felt& felt, FieldState& state) noexcept;

 private:
  // Behind pointers, since the constraint looks at the curve and a law may be moved.
  std::unique_ptr<const control::SampledCurve> curve_;
  std::unique_ptr<control::CurveConstraint> constraint_;
  control::PdController controller_;
  FoundEnd end_;
  double period_;
};

}  // namespace haptrial::scene
