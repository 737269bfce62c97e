#include "core/device/envelope.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "core/base/definition/schema.h"
#include "core/base/longer.h"

namespace haptrial::device {
namespace {

constexpr double kGrowthInDoubt = 2.0;  // times the holding force, while readings are suspicious
constexpr double kFallInDoubt = 20.0;   // while the position may be frozen [N/s]
constexpr double kNotFelt = 0.2;        // change of force in a tick [N]

// Bounds of a session that begins. No value takes a check out of use: ramps and changes are no
// steps, and as a force that fades gives way to no hand, one that lets go is not pushed far.
constexpr Bounds kForceRate{10.0, 10'000.0};  // [N/s]
constexpr Bounds kRampIn{0.05, 10.0};         // [s]
constexpr Bounds kRampOut{0.05, 0.5};         // [s]
constexpr Bounds kChange{0.05, 0.2};          // [s]
constexpr Bounds kSaturation{0.0, 3.0};       // [s]
constexpr Bounds kHolding{0.0, 2.0};          // [N]

}  // namespace

const Schema<EnvelopeLimits>& envelope_schema() {
  using E = EnvelopeLimits;
  static const auto schema =
      Schema<E>()
          .number("max_force", &E::max_force, {0.0, 100.0, true}, "N",
                  "Greatest force that is commanded; a protocol that asks for more is stopped")
          .required()
          .number("max_force_rate", &E::max_force_rate, {10.0, 1e6}, "N/s",
                  "Fastest change of the commanded force; up to 10,000 N/s in a new session")
          .required()
          .number("workspace_radius", &E::workspace_radius, {0.0, 2.0, true}, "m",
                  "Distance from the origin beyond which the force is switched off")
          .required()
          .number("max_speed", &E::max_speed, {0.0, 20.0, true}, "m/s",
                  "Greatest speed of the hand; above it the force is switched off")
          .required()
          .number("max_jump", &E::max_jump, {0.0, 0.1, true}, "m",
                  "Largest change of position between two ticks; a larger one ends the pass")
          .required()
          .number("ramp_in", &E::ramp_in, {0.0, 10.0}, "s",
                  "Time over which the force of a pass grows from zero; 0.05 s or more in a new "
                  "session")
          .required()
          .number("ramp_out", &E::ramp_out, {0.0, 10.0}, "s",
                  "Time over which the force falls to zero after a normal end; 0.05 to 0.5 s in a "
                  "new session")
          .required()
          .number(
              "change_time", &E::change_time, {0.0, 10.0}, "s",
              "Time over which the force goes over to that of another stage, question or object; "
              "0.05 to 0.2 s in a new session")
          .number("max_saturation", &E::max_saturation, {0.0, 600.0, true}, "s",
                  "Longest time without a break at max_force; a longer one ends the pass; up to 3 "
                  "s in a new session")
          .number("holding_force", &E::holding_force, {0.0, 10.0, true}, "N",
                  "Change of force that a still hand and friction may hide; beyond it a position "
                  "that does not change counts as frozen; up to 2 N in a new session")
          .otherwise("from the friction of [hand]");
  return schema;
}

void check_new_envelope(Table& table, const EnvelopeLimits& limits) {
  const auto check = [&table](const char* key, double value, const Bounds& bounds,
                              const char* unit) {
    if (table.has(key) && !(value >= bounds.low && value <= bounds.high)) {
      table.reject(key, fmt::format("{:g}", value),
                   fmt::format("{:g} to {:g} [{}]", bounds.low, bounds.high, unit));
    }
  };
  check("max_force_rate", limits.max_force_rate, kForceRate, "N/s");
  check("ramp_in", limits.ramp_in, kRampIn, "s");
  check("ramp_out", limits.ramp_out, kRampOut, "s");
  check("change_time", limits.change_time, kChange, "s");
  check("max_saturation", limits.max_saturation, kSaturation, "s");
  check("holding_force", limits.holding_force, kHolding, "N");
}

Envelope::Envelope(const EnvelopeLimits& limits)
    : limits_(limits),
      readings_(limits.holding_force),
      forces_(limits.max_force, limits.max_saturation) {
  const bool positive = limits.max_force > 0.0 && limits.max_force_rate > 0.0 &&
                        limits.workspace_radius > 0.0 && limits.max_speed > 0.0 &&
                        limits.max_jump > 0.0 && limits.ramp_in >= 0.0 && limits.ramp_out >= 0.0 &&
                        limits.change_time >= 0.0 && limits.max_saturation > 0.0 &&
                        limits.holding_force > 0.0;
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
    ForceIntent meant = intent;
    const Eigen::Vector3d force = approach(target(wanted, dt, meant), dt);
    watch_force(force, dt, meant);
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
  if (readings_.in_doubt()) {
    bound_ = std::max(0.0, std::min(bound_, last_force_.norm()) - kFallInDoubt * dt);
  }
  if (bounded_ && !suspicious) {
    go_over();  // what was held back comes by degrees
  }
  bounded_ = suspicious;
}

void Envelope::watch_force(const Eigen::Vector3d& force, double dt,
                           const ForceIntent& intent) noexcept {
  const Fault odd = forces_.look(force, intent.stimulus, dt);
  if (odd != Fault::kNone) {
    trip(odd);
  }
  ForceIntent acted = std::exchange(before_last_intent_, std::exchange(last_intent_, intent));
  if (!fresh_) {
    return;
  }
  acted.stored = intent.stored;
  acted.added = intent.added;
  // While the force ramps or is held back, what the springs hold is not what the protocol says.
  const bool ramps = released_ || bounded_ || since_start_ < limits_.ramp_in;
  const Eigen::Vector3d moved = last_position_ - watched_position_;
  const bool first = !std::exchange(has_watched_, true);
  watched_position_ = last_position_;
  if (ramps || first) {
    energy_.reset();
  } else if (energy_.look(before_last_force_, moved, acted, dt)) {
    trip(Fault::kEnergy);
  }
}

/// The rest of the force from before the protocol went over to others; it fades.
/// @param wanted  without the stimulus, and less the stimulus that ended [N]
Eigen::Vector3d Envelope::blend(const Eigen::Vector3d& wanted, double dt) noexcept {
  if (std::exchange(goes_over_, false)) {
    left_over_ = followed_ - wanted;
    since_change_ = 0.0;
    if (!longer(left_over_, kNotFelt)) {
      left_over_
          .setZero();  // what the hand's own movement changes from tick to tick stays as it is
    }
  }
  since_change_ += dt;
  const double u = since_change_ / limits_.change_time;
  if (!(u < 1.0)) {
    left_over_.setZero();
  }
  return (1.0 - u * u * (3.0 - 2.0 * u)) * left_over_;
}

/// @param intent  of `wanted`; comes back as that of the force
Eigen::Vector3d Envelope::target(const Eigen::Vector3d& wanted, double dt,
                                 ForceIntent& intent) noexcept {
  if (released_) {
    intent = {};
    since_release_ += dt;
    return since_release_ < limits_.ramp_out
               ? Eigen::Vector3d((1.0 - since_release_ / limits_.ramp_out) * released_force_)
               : Eigen::Vector3d::Zero();
  }
  since_start_ += dt;
  const double share = limits_.ramp_in > 0.0 ? std::min(1.0, since_start_ / limits_.ramp_in) : 1.0;
  const Eigen::Vector3d left_over = blend(wanted - intent.stimulus - intent.ended, dt);
  const Eigen::Vector3d grown = share * (wanted + left_over);
  const double most = bounded_ ? std::min(bound_, limits_.max_force) : limits_.max_force;
  const double passed = longer(grown, most) ? most / grown.norm() : 1.0;
  followed_ = passed * (wanted + left_over - intent.stimulus);
  intent.push = passed * share * (intent.push + left_over);
  intent.stimulus *= passed * share;
  return passed * grown;
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
  bounded_ = goes_over_ = false;
  followed_.setZero();
  left_over_.setZero();
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
  released_ = goes_over_ = false;
  since_start_ = 0.0;
  followed_.setZero();
  left_over_.setZero();
}

void Envelope::resume() noexcept {
  last_force_.setZero();
  before_last_force_.setZero();
  has_position_ = has_watched_ = false;
  readings_.reset();
  since_start_ = 0.0;
  since_release_ = limits_.ramp_out;
}

}  // namespace haptrial::device
