#pragma once

#include <Eigen/Core>

#include "core/control/curve_tracker.h"
#include "core/control/pd_controller.h"

namespace haptrial::control {

/// A virtual fixture: a spring and damper that hold the tool T on a curve and leave it free along
/// it. With c the place that belongs to the tool and n = 1 - u uᵀ across the curve's direction u,
///
///     f_W = k (p_Wc - p_WT) - b n v_WT
///
/// The spring is minus the gradient of ½ k (distance)², so it does no work over a closed path and
/// points across the curve by itself; the damper takes energy only. Beyond an end the tool is held
/// to the end's point from every side; along the curve the damper grows over the first millimetre,
/// so that it does not strike the hand. Source: Morris 2006, §6.2.2.
class CurveConstraint {
 public:
  /// @param curve  in W; outlives the constraint.
  /// @throws std::invalid_argument naming the parameter that breaks its bound.
  CurveConstraint(const SampledCurve& curve, const PdGains& gains,
                  const CurveFollowing& following = {});

  // Servo thread, all of them: no allocation, lock, I/O or throw.
  /// Starts at the nearest place of the whole curve.
  void start(const Eigen::Vector3d& tool) noexcept { tracker_.start(tool); }
  void start_at(double arc) noexcept { tracker_.start_at(arc); }
  /// Moves the place along with the tool. @returns where it is, moving along with the tool as far
  /// as that is along the curve: what a spring and damper pull the tool to.
  PointState follow(const PointState& tool) noexcept;
  /// follow(), and the force on the tool [N]; zero where the tool is not finite.
  Eigen::Vector3d force(const PointState& tool) noexcept;

  const CurvePlace& place() const noexcept { return tracker_.place(); }
  const Eigen::Vector3d& direction() const noexcept { return direction_; }  // u

 private:
  CurveTracker tracker_;
  PdController controller_;
  Eigen::Vector3d direction_{Eigen::Vector3d::Zero()};
};

}  // namespace haptrial::control
