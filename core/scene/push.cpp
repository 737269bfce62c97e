#include "core/scene/push.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "core/base/require.h"
#include "core/control/pd_controller.h"

namespace haptrial::scene {

using Eigen::Vector3d;

namespace {

constexpr double kComesAndGoes = 0.05;  // a measured value, so that the force takes no step [s]
constexpr double kAlternates = 5.0;     // faster than this a measured force alternates [Hz]

}  // namespace

Constant::Constant(const ConstantParameters& parameters, const Setting& setting)
    : force_(control::saturate(parameters.force, setting.limit)) {
  require(parameters.force.allFinite(), "Constant: force must be finite");
}

Ramp::Ramp(const RampParameters& parameters, const Setting&) : parameters_(parameters) {
  require(parameters.from.allFinite(), "Ramp: from must be finite");
  require(parameters.to.allFinite(), "Ramp: to must be finite");
  require(std::isfinite(parameters.rise) && parameters.rise > 0.0,
          "Ramp: rise must be finite and above 0");
}

Vector3d Ramp::force(const Felt& felt, FieldState& state) noexcept {
  const double u = std::min(felt.time / parameters_.rise, 1.0);
  state.done = u >= 1.0;
  return parameters_.from + u * (parameters_.to - parameters_.from);
}

Pulse::Pulse(const PulseParameters& parameters, const Setting&) : parameters_(parameters) {
  require(parameters.force.allFinite(), "Pulse: force must be finite");
  require(std::isfinite(parameters.delay) && parameters.delay >= 0.0,
          "Pulse: delay must be finite and at least 0");
  require(std::isfinite(parameters.duration) && parameters.duration > 0.0,
          "Pulse: duration must be finite and above 0");
  require(parameters.rise >= 0.0 && parameters.rise <= 0.5 * parameters.duration,
          "Pulse: rise must be from 0 to half the duration");
}

Vector3d Pulse::force(const Felt& felt, FieldState& state) noexcept {
  const double t = felt.time - parameters_.delay;
  state.done = t >= parameters_.duration;
  if (t < 0.0 || state.done) {
    return Vector3d::Zero();
  }
  const double edge = std::min(t, parameters_.duration - t);
  if (edge >= parameters_.rise) {
    return state.stimulus = parameters_.force;
  }
  const double risen = 0.5 * (1.0 - std::cos(std::numbers::pi * edge / parameters_.rise));
  return state.stimulus = risen * parameters_.force;
}

Measured::Measured(const MeasuredParameters& parameters, const Setting& setting)
    : parameters_(parameters),
      value_(parameters.zero),
      most_change_(1.0 / (kComesAndGoes * setting.rate)),
      most_step_(parameters.stimulus || parameters.gain.isZero(0.0)
                     ? std::numeric_limits<double>::infinity()
                     : setting.limit * most_change_ / parameters.gain.norm()),
      slow_(kAlternates, setting.rate) {
  require(std::isfinite(parameters.zero), "Measured: zero must be finite");
  require(parameters.gain.allFinite(), "Measured: gain must be finite");
}

void Measured::adopt(const Measured& before) noexcept {
  value_ = before.value_;
  share_ = before.share_;
  begun_ = before.begun_;
  slow_.adopt(before.slow_);
}

Vector3d Measured::force(const Felt& felt, FieldState& state) noexcept {
  const std::size_t at = parameters_.channel;
  const bool there = at < felt.channels.size() && std::isfinite(felt.channels[at]);
  const double wanted = there ? 1.0 : 0.0;
  const bool begins = !std::exchange(begun_, true);
  if (there) {
    const double change = felt.channels[at] - value_;
    value_ += begins ? change : std::clamp(change, -most_step_, most_step_);
  }
  share_ += begins ? wanted : std::clamp(wanted - share_, -most_change_, most_change_);
  const Vector3d force = share_ * (value_ - parameters_.zero) * parameters_.gain;
  if (begins) {
    slow_.start(force);
  }
  if (parameters_.stimulus) {
    state.stimulus = force - slow_.next(force);
  }
  return force;
}

}  // namespace haptrial::scene
