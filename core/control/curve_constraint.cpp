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

PointState CurveConstraint::follow(const PointState& tool) noexcept {
  const CurvePlace& place = tracker_.follow(tool.position);
  direction_ = tracker_.curve().tangent(place, tool.position);

  PointState target{place.position, Vector3d::Zero()};
  const double outward = direction_.dot(tool.position - target.position);
  const bool before = place.arc <= 0.0 && outward < 0.0;
  const bool after = place.arc >= tracker_.curve().length() && outward > 0.0;
  const double beyond = before || after ? std::abs(outward) : 0.0;
  const double free = 1.0 - std::min(beyond / kHeldBeyond, 1.0);
  target.velocity += free * direction_.dot(tool.velocity) * direction_;
  return target;
}

Vector3d CurveConstraint::force(const PointState& tool) noexcept {
  const PointState target = follow(tool);
  return controller_.force(target, tool);
}

}  // namespace haptrial::control
