#include "core/control/curve_tracker.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "core/base/definition/schema.h"

namespace haptrial::control {

const Schema<CurveFollowing>& curve_following_schema() {
  using F = CurveFollowing;
  static const auto schema =
      Schema<F>()
          .number("step", &F::step, {0.0, 1.0, true}, "m",
                  "Distance along the curve that the place on it may move in one tick")
          .required()
          .number("reach", &F::reach, {0.0, 1.0, true}, "m",
                  "Distance along the curve that is searched ahead of the place")
          .required()
          .number("margin", &F::margin, {0.0, 1.0}, "m",
                  "Distance by which a farther place must be nearer to the hand to be taken")
          .required()
          .check([](Table& table, const F& f) {
            if (f.reach < f.step) {
              table.reject("reach", fmt::format("{}", f.reach),
                           fmt::format("at least step, {} [m]", f.step));
            }
          });
  return schema;
}

namespace {

/// Segment to begin at: on a curve that the cache does not hold, the one that the tool would be
/// beside were the curve straight and evenly sampled from here on, so that nothing is read in vain.
std::size_t likely_segment(const SampledCurve& curve, std::size_t segment,
                           const Eigen::Vector3d& tool) noexcept {
  constexpr std::size_t kCached = 20000;  // points
  if (curve.size() <= kCached) {
    return segment;
  }
  const Eigen::Vector3d from = curve.point(segment);
  const Eigen::Vector3d chord = curve.point(segment + 1) - from;
  const double at = static_cast<double>(segment) + (tool - from).dot(chord) / chord.squaredNorm();
  const auto last = static_cast<double>(curve.size() - 2);
  return at > 0.0 ? static_cast<std::size_t>(std::fmin(at, last)) : segment;  // not a number: here
}

}  // namespace

CurveTracker::CurveTracker(const SampledCurve& curve, const CurveFollowing& following)
    : curve_(&curve), following_(following) {
  if (!(following.step > 0.0) || !std::isfinite(following.step)) {
    throw std::invalid_argument("CurveTracker: step must be finite and above 0");
  }
  if (!(following.reach >= following.step)) {
    throw std::invalid_argument("CurveTracker: reach must be at least step");
  }
  if (!(following.margin >= 0.0)) {
    throw std::invalid_argument("CurveTracker: margin must be at least 0");
  }
  if (!(following.tolerance >= 0.0)) {
    throw std::invalid_argument("CurveTracker: tolerance must be at least 0");
  }
  start_at(0.0);
}

const CurvePlace& CurveTracker::start(const Eigen::Vector3d& tool) noexcept {
  CurveQuery query;
  query.from_segment = place_.segment;
  query.tolerance = following_.tolerance;
  if (const auto found = curve_->nearest(tool, query)) {
    place_ = *found;
  }
  return place_;
}

const CurvePlace& CurveTracker::start_at(double arc) noexcept {
  place_ = curve_->at(arc);
  return place_;
}

const CurvePlace& CurveTracker::follow(const Eigen::Vector3d& tool) noexcept {
  const CurveFollowing& f = following_;
  const double before = curve_->arc_of(place_.segment, place_.t);
  CurveQuery query;
  query.window = {before - f.step, before + f.step};
  query.from_segment = likely_segment(*curve_, place_.segment, tool);
  query.tolerance = f.tolerance;
  const auto near = curve_->nearest(tool, query);
  if (!near) {
    return place_;
  }
  place_ = *near;
  const double nearer = near->distance - f.margin;
  if (f.reach > f.step && nearer > 0.0 && !is_clear(tool, before, nearer)) {
    look_further(tool, before, query);
  }
  return place_;
}

/// Whether no place beyond `step` of `arc` and within `reach` can be nearer than `distance`. A tool
/// that moved by m is at most m nearer to any place; a place that has come within reach since lies
/// within the shift of one that was.
bool CurveTracker::is_clear(const Eigen::Vector3d& tool, double arc,
                            double distance) const noexcept {
  if (clearance_.near < 0.0) {
    return false;
  }
  const double moved = (tool - clearance_.tool).norm();
  const double shifted = std::abs(arc - clearance_.arc);
  return std::fmin(clearance_.near, clearance_.far - shifted) - moved >= distance;
}

/// @param query  that found place_, the nearest within `step`
void CurveTracker::look_further(const Eigen::Vector3d& tool, double arc,
                                CurveQuery query) noexcept {
  const CurveFollowing& f = following_;
  const double nearer = place_.distance - f.margin;
  query.known = query.window;
  query.window = {arc - f.reach, arc + f.reach};
  query.below = nearer + f.step;  // farther than it need be: what it shows holds for some ticks
  const auto found = curve_->nearest(tool, query);
  const double far = (found ? found->distance : query.below) - f.tolerance;
  clearance_ = {tool, arc, place_.distance - f.tolerance, far};
  if (found && found->distance < nearer) {
    place_ = *found;
  }
}

}  // namespace haptrial::control
