#include "core/subject/perceiver/contour.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace haptrial::subject {

using Eigen::Vector3d;

namespace {

constexpr double kFeltAtLeast = 0.1;  // less is no contact [N]
constexpr double kNormalTime = 0.02;  // over which the felt normal is averaged [s]
constexpr double kTurning = 12.0;     // behind an edge [rad/s]
constexpr double kReaction = 0.15;    // what is felt before is from before [s]
constexpr double kFarthest = 0.1;     // from where it began, if nothing is there [m]
constexpr double kAlong = 0.9;        // cosine from which an axis comes out of the surface
constexpr double kLost = 0.5;         // without contact: it goes back to where it last was [s]

/// `v` across `axis`; something across it where nothing is left.
Vector3d across(const Vector3d& v, const Vector3d& axis) noexcept {
  const Vector3d rest = v - v.dot(axis) * axis;
  return rest.norm() > 1e-6 * v.norm() ? Vector3d(rest.normalized()) : axis.unitOrthogonal();
}

}  // namespace

void ContourFollower::begin(const Contour& contour, const Vector3d& at) noexcept {
  contour_ = contour;
  touched_ = false;
  without_ = 0.0;
  start_ = at;
  outward_ = -contour.towards.normalized();
  turn_to(0, at);
}

void ContourFollower::turn_to(std::size_t axis, const Vector3d& at) noexcept {
  turned_ = axis;
  const Vector3d before = axis_;
  axis_ = contour_.around[axis].normalized();
  if (axis > 0 && std::abs(axis_.dot(outward_)) > kAlong) {
    axis_ =
        outward_.cross(before);  // no way leads round an axis that comes out of the surface here
  }
  outward_ = across(outward_, axis_);
  plane_ = at;
}

ContourFollower::Step ContourFollower::step(double time, const PointState& hand,
                                            const Vector3d& felt, double dt) noexcept {
  if (turned_ == 0 && time >= contour_.turn_after) {
    turn_to(1, hand.position);
  }
  Step step;
  if (felt.norm() > kFeltAtLeast && time > kReaction) {
    touched_ = true;
    last_ = hand.position;
    without_ = 0.0;
    const Vector3d now = across(felt, axis_);
    outward_ = across(outward_ + std::min(1.0, dt / kNormalTime) * (now - outward_), axis_);
  } else if (touched_) {
    without_ += dt;
    outward_ = Eigen::AngleAxisd(kTurning * dt, axis_) * outward_;
  }
  step.off_loop = (plane_ - hand.position).dot(axis_) * axis_;
  if (!touched_) {
    const bool gives_up = (hand.position - start_).norm() > kFarthest;
    step.velocity = gives_up ? Vector3d(Vector3d::Zero())
                             : Vector3d(contour_.speed * contour_.towards.normalized());
    step.off_loop.setZero();
    plane_ = hand.position;
    return step;
  }
  if (without_ > kLost) {
    step.velocity = contour_.speed * (last_ - hand.position).stableNormalized();
    step.off_loop.setZero();
    return step;
  }
  step.velocity = contour_.speed * axis_.cross(outward_);
  step.push = -contour_.force * outward_;
  return step;
}

}  // namespace haptrial::subject
