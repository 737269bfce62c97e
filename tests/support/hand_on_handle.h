#pragma once

#include "core/device/handle_physics.h"

namespace haptrial::test {

/// A hand of some mass whose posture yields, on a handle of 0.22 kg with 0.1 N of friction.
class HandOnHandle final : public device::HandlePhysics {
 public:
  explicit HandOnHandle(double mass) { hold(mass); }
  void hold(double mass) {
    mass_ = 0.22 + mass;
    damping_ = 15.0 * mass / 0.8;
    stiffness_ = 250.0 * mass / 0.8;
  }
  void put(const Eigen::Vector3d& place) {
    state_ = {place, Eigen::Vector3d::Zero()};
    posture_ = place;
  }
  double press{0.0};                               // downward [N]
  Eigen::Vector3d shake{Eigen::Vector3d::Zero()};  // beside that [N]

  PointState step(const Eigen::Vector3d& motor, double dt) noexcept override {
    constexpr int kSteps = 4;
    constexpr double kFriction = 0.1;     // [N]
    constexpr double kPostureTime = 0.1;  // [s]
    const double h = dt / kSteps;
    for (int i = 0; i < kSteps; ++i) {
      Eigen::Vector3d f =
          motor - stiffness_ * (state_.position - posture_) - damping_ * state_.velocity;
      f.y() -= press;
      f += shake;
      posture_ += h / kPostureTime * (state_.position - posture_);
      state_.velocity += h / mass_ * f;
      const double stop = kFriction / mass_ * h;
      const double speed = state_.velocity.norm();
      state_.velocity *= speed > stop ? 1.0 - stop / speed : 0.0;
      state_.position += h * state_.velocity;
    }
    return state_;
  }
  PointState state() const noexcept override { return state_; }

 private:
  double mass_{0.0};
  double damping_{0.0};
  double stiffness_{0.0};
  PointState state_{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  Eigen::Vector3d posture_{Eigen::Vector3d::Zero()};
};

}  // namespace haptrial::test
