#include "core/device/envelope.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/base/table.h"

namespace haptrial::device {

EnvelopeLimits read_envelope_limits(Table& table) {
  EnvelopeLimits limits;
  limits.max_force = table.number("max_force", {0.0, 100.0, true}, "N");
  limits.max_force_rate = table.number("max_force_rate", {10.0, 1e6}, "N/s");
  limits.workspace_radius = table.number("workspace_radius", {0.0, 2.0, true}, "m");
  limits.max_speed = table.number("max_speed", {0.0, 20.0, true}, "m/s");
  limits.max_jump = table.number("max_jump", {0.0, 0.1, true}, "m");
  limits.ramp_in = table.number("ramp_in", {0.0, 10.0}, "s");
  limits.ramp_out = table.number("ramp_out", {0.0, 10.0}, "s");
  return limits;
}

const char* describe(Fault fault) noexcept {
  switch (fault) {
    case Fault::kNone:
      return "no fault";
    case Fault::kReadFailed:
      return "the device did not answer";
    case Fault::kWriteFailed:
      return "the device refused the force";
    case Fault::kPositionNotFinite:
      return "the device gave a position that is not a number";
    case Fault::kJump:
      return "the position jumped further between two ticks than a hand can move";
    case Fault::kSpeed:
      return "the tool moved faster than the envelope allows";
    case Fault::kWorkspace:
      return "the tool left the workspace";
    case Fault::kForceNotFinite:
      return "the protocol asked for a force that is not a number";
    case Fault::kForceTooLarge:
      return "the protocol asked for more force than the envelope allows";
    case Fault::kForcesOff:
      return "the device switched its motors off";
    case Fault::kStopButton:
      return "the device's stop button was pressed";
    case Fault::kEmergencyStop:
      return "emergency stop";
    case Fault::kOrientationNotFinite:
      return "the device gave an orientation that is none";
  }
  return "unknown fault";
}

Envelope::Envelope(const EnvelopeLimits& limits) : limits_(limits) {
  const bool positive = limits.max_force > 0.0 && limits.max_force_rate > 0.0 &&
                        limits.workspace_radius > 0.0 && limits.max_speed > 0.0 &&
                        limits.max_jump > 0.0 && limits.ramp_in >= 0.0 && limits.ramp_out >= 0.0;
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
  if (has_position_ && (p - last_position_).norm() > limits_.max_jump) {
    trip(Fault::kJump);
  } else if (reading.tool.velocity.norm() > limits_.max_speed) {
    trip(Fault::kSpeed);
  } else if (p.norm() > limits_.workspace_radius) {
    trip(Fault::kWorkspace);
  }
  last_position_ = p;
  has_position_ = true;
  return fault_;
}

Eigen::Vector3d Envelope::limit(const Eigen::Vector3d& wanted, double dt) noexcept {
  // A hair above the limit is rounding of a force that was saturated to it.
  constexpr double kRounding = 1.0 + 1e-9;
  if (!wanted.allFinite() || !(dt > 0.0)) {
    trip(Fault::kForceNotFinite);
  } else if (wanted.norm() > limits_.max_force * kRounding) {
    trip(Fault::kForceTooLarge);
  }
  if (fault_ != Fault::kNone) {
    last_force_.setZero();
    return last_force_;
  }
  const Eigen::Vector3d goal = target(wanted, dt);
  const Eigen::Vector3d change = goal - last_force_;
  const double step = change.norm();
  const double allowed = limits_.max_force_rate * dt;
  last_force_ = step > allowed ? Eigen::Vector3d(last_force_ + change * (allowed / step)) : goal;
  return last_force_;
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
  const double length = grown.norm();
  return length > limits_.max_force ? Eigen::Vector3d(grown * (limits_.max_force / length)) : grown;
}

void Envelope::trip(Fault fault) noexcept {
  if (fault_ == Fault::kNone) {  // the first fault is the cause
    fault_ = fault;
    last_force_.setZero();
  }
}

void Envelope::reset() noexcept {
  fault_ = Fault::kNone;
  last_force_.setZero();
  has_position_ = false;
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
