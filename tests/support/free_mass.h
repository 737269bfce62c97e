#pragma once

#include "core/device/handle_physics.h"

namespace haptrial::test {

/// A point mass that nothing but the motors' force moves; with `damping` also a hand that is
/// dragged through oil.
class FreeMass final : public device::HandlePhysics {
 public:
  /// Exact for a force that is held over the step, or the symplectic Euler rule, whose error in the
  /// energy of an oscillator does not add up.
  enum class Rule { kExact, kSymplectic };

  explicit FreeMass(double mass, const PointState& start = {}, Rule rule = Rule::kExact,
                    double damping = 0.0)
      : mass_(mass), state_(start), rule_(rule), damping_(damping) {}

  PointState step(const Eigen::Vector3d& force, double dt) noexcept override {
    const Eigen::Vector3d acceleration = (force - damping_ * state_.velocity) / mass_;
    if (rule_ == Rule::kExact) {
      state_.position += dt * state_.velocity + 0.5 * dt * dt * acceleration;
      state_.velocity += dt * acceleration;
    } else {
      state_.velocity += dt * acceleration;
      state_.position += dt * state_.velocity;
    }
    return state_;
  }
  PointState state() const noexcept override { return state_; }
  void place(const PointState& state) noexcept { state_ = state; }

 private:
  double mass_;
  PointState state_;
  Rule rule_;
  double damping_;
};

}  // namespace haptrial::test
