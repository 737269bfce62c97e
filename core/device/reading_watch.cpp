#include "core/device/reading_watch.h"

#include <algorithm>
#include <utility>

#include "core/base/longer.h"

namespace haptrial::device {
namespace {

constexpr double kHeaviestHand = 2.0;    // with the handle [kg]
constexpr double kFrozenWay = 6e-5;      // [m]
constexpr double kProof = 1.5;           // of force that a hand does not lose without moving [N]
constexpr double kGone = 0.25;           // without a force, which is proof of itself [s]
constexpr double kForceMemory = 0.020;   // of the mean force [s]
constexpr double kRest = 1e-4;           // [m/s]
constexpr double kStaleAfter = 0.020;    // [s]
constexpr double kJitterWithin = 0.050;  // [s]
constexpr double kAcceleration = 500.0;  // [m/s^2]
constexpr double kResolution = 1e-4;     // [m]

}  // namespace

Fault ReadingWatch::look(const Eigen::Vector3d& position, const Eigen::Vector3d& velocity,
                         const Eigen::Vector3d& force, double dt) noexcept {
  time_ += dt;
  const Eigen::Vector3d step = position - position_;
  position_ = position;
  Fault fault = Fault::kNone;
  mean_ += (seen_ == 0 ? 1.0 : std::min(1.0, dt / kForceMemory)) * (force - mean_);
  if (seen_ == 0) {
    held_ = force;
  } else {
    const bool equal = step.isZero(0.0);
    const bool stuck = frozen(equal, force, dt);
    fault = stale(equal, velocity, dt) || stuck ? Fault::kFrozen : Fault::kNone;
  }
  velocity_ = velocity;
  if (seen_ > 1 && jitters(step, dt)) {
    fault = Fault::kJitter;
  }
  const double size = step.cwiseAbs().maxCoeff();
  if (seen_ > 0 && size > 0.0 && (smallest_step_ == 0.0 || size < smallest_step_)) {
    smallest_step_ = size;
  }
  step_ = step;
  seen_ = std::min(seen_ + 1, 2);
  return fault;
}

bool ReadingWatch::frozen(bool equal, const Eigen::Vector3d& force, double dt) noexcept {
  if (!equal || equal_for_ == 0.0) {
    held_ = mean_;
    equal_for_ = equal ? dt : 0.0;
    free_speed_.setZero();
    free_way_.setZero();
    doubted_ = gone_for_ = 0.0;
    return false;
  }
  equal_for_ += dt;
  if (doubted_ > 0.0) {
    gone_for_ = force.isZero(0.0) ? gone_for_ + dt : 0.0;
    return doubted_ - force.norm() >= kProof || gone_for_ >= kGone;
  }
  const Eigen::Vector3d change = force - held_;
  // A force that friction alone could hold can take nothing from a hand, either. One that turns
  // round brings it back: a vibration moves a hand by less than an encoder sees.
  const bool turns = free_speed_.dot(change) < 0.0;
  if (turns || !longer(change, holding_force_) || !longer(force, holding_force_)) {
    free_speed_.setZero();
    free_way_.setZero();
    return false;
  }
  free_speed_ += change / kHeaviestHand * dt;
  free_way_ += free_speed_ * dt;
  if (longer(free_way_, std::max(kFrozenWay, 2.0 * smallest_step_))) {
    doubted_ = std::max(force.norm(), 1e-9);
  }
  return false;
}

/// An estimate of velocity comes to zero where the position stays the same.
bool ReadingWatch::stale(bool equal, const Eigen::Vector3d& velocity, double dt) noexcept {
  const bool same = equal && velocity == velocity_ && velocity.norm() > kRest;
  stale_for_ = same ? stale_for_ + dt : 0.0;
  return stale_for_ >= kStaleAfter;
}

/// Way at the mean speed of the last readings; there and back again adds nothing to it.
double ReadingWatch::way_in_two_ticks(double dt) noexcept {
  Place& place = passed_[passes_ % passed_.size()];
  const Place oldest = passes_ < passed_.size() ? passed_.front() : place;
  place = {position_, time_};
  ++passes_;
  const double tick = std::max(dt, std::exchange(dt_, dt));
  const double since = time_ - oldest.time;
  return passes_ > 1 && since > 0.0 ? 2.0 * tick * (position_ - oldest.position).norm() / since
                                    : 0.0;
}

bool ReadingWatch::jitters(const Eigen::Vector3d& step, double dt) noexcept {
  odd_for_ = std::max(0.0, odd_for_ - dt);
  // A coarse encoder goes on by whole steps now and then; one that jitters turns back by them.
  const double resolution = std::max(kResolution, 1.5 * smallest_step_);
  const double free = std::max(resolution, kAcceleration * dt * dt) + way_in_two_ticks(dt);
  if ((step - step_).norm() <= free) {
    return false;
  }
  odd_for_ = kJitterWithin;
  double& oldest = odd_at_[static_cast<std::size_t>(odd_ % (kJitterTicks - 1))];
  const double since = time_ - oldest;
  oldest = time_;
  ++odd_;
  return odd_ >= kJitterTicks && since <= kJitterWithin;
}

}  // namespace haptrial::device
