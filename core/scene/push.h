#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>

#include "core/scene/field_state.h"
#include "core/scene/low_pass.h"

namespace haptrial::scene {

class Constant;
class Ramp;
class Pulse;
class Measured;

struct ConstantParameters {
  using Law = Constant;
  Eigen::Vector3d force{Eigen::Vector3d::Zero()};  // f_W [N]

  StiffnessBound bound() const { return {true, 0.0, 0.0}; }
  FieldTraits traits() const { return {.asked_force = force.norm()}; }
};

/// f(t) = f. Conservative: its energy is -f · p.
class Constant {
 public:
  /// @throws std::invalid_argument naming the parameter that breaks its bound; so do all fields.
  Constant(const ConstantParameters& parameters, const Setting& setting);
  // Servo thread, these functions of all fields: no allocation, lock, I/O or throw.
  Eigen::Vector3d force(const Felt&, FieldState&) noexcept { return force_; }
  double energy(const Eigen::Vector3d& p) const noexcept { return -force_.dot(p); }  // [J]

 private:
  Eigen::Vector3d force_;  // limited, so that it is minus the gradient
};

struct RampParameters {
  using Law = Ramp;
  Eigen::Vector3d from{Eigen::Vector3d::Zero()};  // f_0 [N]
  Eigen::Vector3d to{Eigen::Vector3d::Zero()};    // f_1 [N]
  double rise{1.0};                               // R > 0 [s]

  StiffnessBound bound() const { return {}; }
  FieldTraits traits() const {
    return {.timed = true, .asked_force = std::max(from.norm(), to.norm())};
  }
};

/// f(t) = f_0 + (f_1 - f_0) min(t / R, 1), with t from the moment it is switched on. Active.
class Ramp {
 public:
  Ramp(const RampParameters& parameters, const Setting& setting);
  Eigen::Vector3d force(const Felt& felt, FieldState& state) noexcept;

 private:
  RampParameters parameters_;
};

struct PulseParameters {
  using Law = Pulse;
  Eigen::Vector3d force{Eigen::Vector3d::Zero()};  // f [N]
  double delay{0.0};                               // from switching on to the first force >= 0 [s]
  double duration{0.1};                            // D from first to last force > 0 [s]
  double rise{0.0};                                // of each edge R, 0 to D / 2 [s]

  StiffnessBound bound() const { return {}; }
  FieldTraits traits() const { return {.timed = true, .asked_force = force.norm()}; }
};

/// f(t) = f g(t - delay), where g rises as (1 - cos(pi t / R)) / 2, stays at 1 and falls in the
/// same way, so that it is back at 0 after D. Active.
class Pulse {
 public:
  Pulse(const PulseParameters& parameters, const Setting& setting);
  Eigen::Vector3d force(const Felt& felt, FieldState& state) noexcept;

 private:
  PulseParameters parameters_;
};

struct MeasuredParameters {
  using Law = Measured;
  std::size_t channel{0};                         // place of the value among those of channels
  double zero{0.0};                               // value without force, in its own unit
  Eigen::Vector3d gain{Eigen::Vector3d::Zero()};  // force for each unit above it, in W [N]
  bool stimulus{false};  // the value alternates by itself: the handle does not oscillate

  StiffnessBound bound() const { return {}; }
  FieldTraits traits() const { return {}; }
};

/// f = w gain (x - zero), where x is the newest value of a channel. While there is none, w goes to
/// 0 over 50 ms, and back to 1 when there is one again. Where it is no stimulus, x follows the
/// channel so that the force takes at least 50 ms for its limit: values that come slowly, or again
/// after a silence, or are wrong for once, make no steps. Active.
class Measured {
 public:
  Measured(const MeasuredParameters& parameters, const Setting& setting);
  void start(const PointState&) noexcept { begun_ = false; }
  void adopt(const Measured& before) noexcept;
  Eigen::Vector3d force(const Felt& felt, FieldState& state) noexcept;

 private:
  MeasuredParameters parameters_;
  double value_;
  double share_{0.0};   // w
  double most_change_;  // of w in a tick
  double most_step_;    // of the value in a tick
  bool begun_{false};
  LowPass slow_;  // of the force
};

}  // namespace haptrial::scene
