#include "core/device/envelope.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "core/base/definition/table.h"
#include "core/base/longer.h"

namespace haptrial::device {
namespace {

constexpr double kGrowthInDoubt = 2.0;  // times the holding force, while readings are suspicious

}  // namespace
EnvelopeLimits read_envelope_limits(Table& table) {
  EnvelopeLimits limits;
  limits.max_force = table.number("max_force", {0.0, 100.0, true}, "N");
  limits.max_force_rate = table.number("max_force_rate", {10.0, 1e6}, "N/s");
  limits.workspace_radius = table.number("workspace_radius", {0.0, 2.0, true}, "m");
  limits.max_speed = table.number("max_speed", {0.0, 20.0, true}, "m/s");
  limits.max_jump = table.number("max_jump", {0.0, 0.1, true}, "m");
  limits.ramp_in = table.number("ramp_in", {0.0, 10.0}, "s");
  limits.ramp_out = table.number("ramp_out", {0.0, 10.0}, "s");
  if (table.has("max_saturation")) {
    limits.max_saturation = table.number("max_saturation", {0.0, 600.0, true}, "s");
  }
  if (table.has("holding_force")) {
    limits.holding_force = table.number("holding_force", {0.0, 10.0, true}, "N");
  }
  return limits;
}

Envelope::Envelope(const EnvelopeLimits& limits)
    : limits_(limits),
      readings_(limits.holding_force),
      forces_(limits.max_force, limits.max_saturation) {
  const bool positive = limits.max_force > 0.0 && limits.max_force_rate > 0.0 &&
                        limits.workspace_radius > 0.0 && limits.max_speed > 0.0 &&
                        limits.max_jump > 0.0 && limits.ramp_in >= 0.0 && limits.ramp_out >= 0.0 &&
                        limits.max_saturation > 0.0 && limits.holding_force > 0.0;
  if (!positive) {
    throw std::invalid_argument("Envelope: every limit must be above 0, and no ramp below");
  }
}

Fault Envelope::check(bool read_ok, const DeviceReading& reading) noexcept {
  if (!read_ok) {
    trip(Fault::kReadFailed);
    return fault_;
  }
  const Eigen::Vector3d& p = reading.tool.position;
  if (!p.allFinite() || !reading.tool.velocity.allFinite()) {
    trip(Fault::kPositionNotFinite);
    return fault_;
  }
  constexpr double kLengthError = 1e-3;  // of a unit quaternion; not met by what is not a number
  if (!(std::abs(reading.orientation.norm() - 1.0) <= kLengthError)) {
    trip(Fault::kOrientationNotFinite);
    return fault_;
  }
  if (reading.stop_pressed) {
    trip(Fault::kStopButton);
  }
  if (!reading.forces_on && !last_force_.isZero(0.0)) {
    trip(Fault::kForcesOff);
  }
  if (has_position_ && longer(p - last_position_, limits_.max_jump)) {
    trip(Fault::kJump);
  } else if (longer(reading.tool.velocity, limits_.max_speed)) {
    trip(Fault::kSpeed);
  } else if (longer(p, limits_.workspace_radius)) {
    trip(Fault::kWorkspace);
  }
  last_position_ = p;
  last_velocity_ = reading.tool.velocity;
  has_position_ = true;
  fresh_ = true;
  return fault_;
}

Eigen::Vector3d Envelope::limit(const Eigen::Vector3d& wanted, double dt,
                                const ForceIntent& intent) noexcept {
  // A hair above the limit is rounding of a force that was saturated to it.
  constexpr double kRounding = 1.0 + 1e-9;
  if (!wanted.allFinite() || !(dt > 0.0)) {
    trip(Fault::kForceNotFinite);
  } else if (longer(wanted, limits_.max_force * kRounding)) {
    trip(Fault::kForceTooLarge);
  }
  if (fault_ == Fault::kNone) {
    watch_readings(dt);
  }
  if (fault_ == Fault::kNone) {
    const Eigen::Vector3d force = approach(target(wanted, dt), dt);
    watch_force(force, wanted, dt, intent);
    before_last_force_ = last_force_;
    last_force_ = fault_ == Fault::kNone ? force : Eigen::Vector3d(Eigen::Vector3d::Zero());
  }
  fresh_ = false;
  return last_force_;
}

/// Towards the goal, no faster than max_force_rate.
Eigen::Vector3d Envelope::approach(const Eigen::Vector3d& goal, double dt) const noexcept {
  const Eigen::Vector3d change = goal - last_force_;
  const double allowed = limits_.max_force_rate * dt;
  return longer(change, allowed) ? Eigen::Vector3d(last_force_ + change * (allowed / change.norm()))
                                 : goal;
}

void Envelope::watch_readings(double dt) noexcept {
  if (!fresh_) {
    return;
  }
  const Fault odd = readings_.look(last_position_, last_velocity_, last_force_, dt);
  if (odd != Fault::kNone) {
    trip(odd);
  }
  const bool suspicious = readings_.suspicious();
  if (suspicious && !bounded_) {
    bound_ = last_force_.norm() + kGrowthInDoubt * limits_.holding_force;
  }
  bounded_ = suspicious;
}

void Envelope::watch_force(const Eigen::Vector3d& force, const Eigen::Vector3d& wanted, double dt,
                           ForceIntent intent) noexcept {
  const Fault odd = forces_.look(force, dt);
  if (odd != Fault::kNone) {
    trip(odd);
  }
  const double asked = wanted.norm();
  intent.push *= asked > 0.0 ? std::min(1.0, force.norm() / asked) : 0.0;
  ForceIntent acted = std::exchange(before_last_intent_, std::exchange(last_intent_, intent));
  if (!fresh_) {
    return;
  }
  acted.stored = intent.stored;
  acted.added = intent.added;
  // While the force ramps, what the springs hold is not what the protocol says.
  const bool ramps = released_ || since_start_ < limits_.ramp_in;
  const Eigen::Vector3d moved = last_position_ - watched_position_;
  const bool first = !std::exchange(has_watched_, true);
  watched_position_ = last_position_;
  if (ramps || first) {
    energy_.reset();
  } else if (energy_.look(before_last_force_, moved, acted, dt)) {
    trip(Fault::kEnergy);
  }
}

Eigen::Vector3d Envelope::target(const Eigen::Vector3d& wanted, double dt) noexcept {
  if (released_) {
    since_release_ += dt;
    return since_release_ < limits_.ramp_out
               ? Eigen::Vector3d((1.0 - since_release_ / limits_.ramp_out) * released_force_)
               : Eigen::Vector3d::Zero();
  }
  since_start_ += dt;
  const double share = limits_.ramp_in > 0.0 ? std::min(1.0, since_start_ / limits_.ramp_in) : 1.0;
  const Eigen::Vector3d grown = share * wanted;
  const double most = bounded_ ? std::min(bound_, limits_.max_force) : limits_.max_force;
  return longer(grown, most) ? Eigen::Vector3d(grown * (most / grown.norm())) : grown;
}

void Envelope::trip(Fault fault) noexcept {
  if (fault_ == Fault::kNone) {  // the first fault is the cause
    fault_ = fault;
    last_force_.setZero();
    before_last_force_.setZero();
  }
}

void Envelope::reset() noexcept {
  fault_ = Fault::kNone;
  last_force_.setZero();
  before_last_force_.setZero();
  has_position_ = has_watched_ = false;
  bounded_ = false;
  readings_.reset();
  forces_.reset();
  engage();
}

void Envelope::release() noexcept {
  if (!released_) {
    released_ = true;
    released_force_ = last_force_;
    since_release_ = 0.0;
  }
}

void Envelope::engage() noexcept {
  released_ = false;
  since_start_ = 0.0;
}

}  // namespace haptrial::device
