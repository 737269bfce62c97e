#pragma once

#include "core/base/definition/schema_forward.h"
#include "core/control/sampled_curve.h"

namespace haptrial::control {

/// How a constraint moves along its curve from one tick to the next.
struct CurveFollowing {
  double step{0.001};      // of arc that it may move freely in a tick, to either side > 0 [m]
  double reach{0.005};     // and at most, where that brings it nearer by `margin` >= step [m]
  double margin{0.0001};   // >= 0 [m]
  double tolerance{1e-9};  // of the distance: CurveQuery::tolerance >= 0 [m]
};

/// The keys of guidance.following.
const Schema<CurveFollowing>& curve_following_schema();

/// The place of a curve that belongs to a tool, with continuity: a strand that the tool passes or
/// crosses is not jumped to, however near it comes, while it is farther along the arc than `reach`.
///
///     near = nearest place with |arc - arc before| <= step
///     far  = nearest place with |arc - arc before| <= reach
///     place = far where it is nearer than near by more than margin, else near
///
/// So the tool may cut a corner, and between two places that are about equally near the answer
/// stays where it is. The place before is always among those compared: no change of place brings it
/// farther from the tool, and the energy of a spring to it never rises by one. The source penalises
/// distance along the arc instead, which drags on a tool that moves along.
/// Source: Morris 2006, §6.2.2, Figure 46.
class CurveTracker {
 public:
  /// @param curve  outlives the tracker.
  /// @throws std::invalid_argument naming the parameter that breaks its bound.
  explicit CurveTracker(const SampledCurve& curve, const CurveFollowing& following = {});

  // Servo thread, all of them.
  /// The nearest place of the whole curve, however far from the place before.
  const CurvePlace& start(const Eigen::Vector3d& tool) noexcept;
  const CurvePlace& start_at(double arc) noexcept;  // held at the ends [m]
  /// Moves the place to the curve's point for `tool`; if that is not finite, the place stays.
  const CurvePlace& follow(const Eigen::Vector3d& tool) noexcept;

  const CurvePlace& place() const noexcept { return place_; }
  const SampledCurve& curve() const noexcept { return *curve_; }

 private:
  /// Result of the last look beyond `step`, so that it need not be made on every tick: as seen from
  /// `tool` and about `arc`, places within `step` were no nearer than `near`, those beyond it no
  /// nearer than `far`.
  struct Clearance {
    Eigen::Vector3d tool{Eigen::Vector3d::Zero()};
    double arc{0.0};
    double near{-1.0};  // below 0: nothing is known
    double far{-1.0};
  };
  bool is_clear(const Eigen::Vector3d& tool, double arc, double distance) const noexcept;
  void look_further(const Eigen::Vector3d& tool, double arc, CurveQuery query) noexcept;

  const SampledCurve* curve_;
  CurveFollowing following_;
  CurvePlace place_;
  Clearance clearance_;
};

}  // namespace haptrial::control
