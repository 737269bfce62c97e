#include "core/scene/path.h"

#include <algorithm>
#include <cmath>

#include "core/base/require.h"

namespace haptrial::scene {
namespace {

constexpr double kSpeedBlend = 0.08;  // [s]

stimulus::SpatialTrajectory travelled(const PathParameters& p) {
  require(std::isfinite(p.duration) && p.duration > 0.0,
          "PathGuide: duration must be finite and above 0");
  double length = 0.0;
  for (std::size_t i = 1; i < p.points.size(); ++i) {
    length += (p.points[i] - p.points[i - 1]).norm();
  }
  require(std::isfinite(length) && length > 0.0,
          "PathGuide: points must be finite and not all the same");
  return stimulus::SpatialTrajectory(p.points, length / p.duration);
}

}  // namespace

PathGuide::PathGuide(const PathParameters& p, const Setting&)
    : path_(travelled(p)), controller_(p.gains) {}

/// The mean lies before `time` at the beginning of the path and behind it at the end, so that it
/// begins and ends at 0.
Eigen::Vector3d PathGuide::mean_velocity(double time) const noexcept {
  const double travelled = std::clamp(time / path_.duration(), 0.0, 1.0);
  const double from = time - (1.0 - travelled) * kSpeedBlend;
  const double to = from + kSpeedBlend;
  return (path_.at(to).position - path_.at(from).position) / kSpeedBlend;
}

Eigen::Vector3d PathGuide::force(const Felt& felt, FieldState& state) noexcept {
  PointState target = path_.at(felt.time);
  target.velocity = mean_velocity(felt.time);
  state.depth = (target.position - felt.hand.position).norm();
  state.done = felt.time >= path_.duration();
  return controller_.force(target, felt.hand, felt.shares);
}

CurveHold::CurveHold(const CurveParameters& p, const Setting& setting)
    : curve_(std::make_unique<control::SampledCurve>(p.points)),
      constraint_(std::make_unique<control::CurveConstraint>(*curve_, p.gains)),
      controller_(p.gains),
      end_(p.gains),
      period_(1.0 / setting.rate) {}

void CurveHold::adopt(const CurveHold& before) noexcept {
  const control::CurvePlace& place = before.constraint_->place();
  const bool same =
      curve_->size() == before.curve_->size() && curve_->length() == before.curve_->length();
  if (same) {
    constraint_->start_at(place.arc);
  } else {
    constraint_->start(place.position);
  }
  end_.start();
}

Eigen::Vector3d CurveHold::force(const Felt& felt, FieldState& state) noexcept {
  const PointState target = constraint_->follow(felt.hand);
  state.depth = (target.position - felt.hand.position).norm();
  const control::GainShares own{1.0, felt.shares.damping / felt.shares.stiffness};
  return felt.shares.stiffness *
         end_.bounded(controller_.force(target, felt.hand, own), felt.hand, period_);
}

}  // namespace haptrial::scene
