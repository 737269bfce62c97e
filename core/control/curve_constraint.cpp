#include "core/control/curve_constraint.h"

#include <algorithm>
#include <cmath>

namespace haptrial::control {
namespace {

constexpr double kHeldBeyond = 1e-3;  // an end, until the damper acts whole along the curve [m]

}  // namespace

using Eigen::Vector3d;

CurveConstraint::CurveConstraint(const SampledCurve& curve, const PdGains& gains,
                                 const CurveFollowing& following)
    : tracker_(curve, following), controller_(gains) {}

void CurveConstraint::start(const Vector3d& tool) noexcept {
  tracker_.start(motion_.pose.inverse(Eigen::Isometry) * tool);
}

PointState CurveConstraint::follow(const PointState& tool) noexcept {
  const Vector3d tool_C = motion_.pose.inverse(Eigen::Isometry) * tool.position;
  const CurvePlace& place = tracker_.follow(tool_C);
  direction_ = motion_.pose.linear() * tracker_.curve().tangent(place, tool_C);

  PointState target;
  target.position = motion_.pose * place.position;
  const Vector3d arm = target.position - motion_.pose.translation();
  target.velocity = motion_.velocity + motion_.angular_velocity.cross(arm);
  const double outward = direction_.dot(tool.position - target.position);
  const bool before = place.arc <= 0.0 && outward < 0.0;
  const bool after = place.arc >= tracker_.curve().length() && outward > 0.0;
  const double beyond = before || after ? std::abs(outward) : 0.0;
  const double free = 1.0 - std::min(beyond / kHeldBeyond, 1.0);
  target.velocity += free * direction_.dot(tool.velocity - target.velocity) * direction_;
  return target;
}

Vector3d CurveConstraint::force(const PointState& tool) noexcept {
  const PointState target = follow(tool);
  return controller_.force(target, tool);
}

}  // namespace haptrial::control
