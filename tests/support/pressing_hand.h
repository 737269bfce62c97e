#pragma once

#include <Eigen/Core>
#include <cmath>

namespace haptrial::test {

/// A hand that presses a tool down along -z: mass, damping and friction of hand and handle as
/// subject::HandParameters has them, the press growing over the first half second. Its posture
/// holds it across, along x and y. The bone's force is held over a tick.
class PressingHand {
 public:
  static constexpr double kMass = 1.02;      // 0.22 of the handle and 0.8 of the hand [kg]
  static constexpr double kDamping = 15.0;   // [N·s/m]
  static constexpr double kFriction = 0.1;   // of the handle, along each axis [N]
  static constexpr double kPosture = 250.0;  // [N/m]

  struct Options {
    double press{1.0};           // [N]
    double friction{kFriction};  // 0 where what it calms is to be seen [N]
    double posture{kPosture};    // [N/m]
  };

  PressingHand(const Eigen::Vector3d& start, const Options& options)
      : options_(options), start_(start), position_(start) {}

  /// One tick of `dt` [s] under the force of the tool on the hand [N].
  void step(const Eigen::Vector3d& force, double dt) {
    constexpr int kSteps = 20;
    const double h = dt / kSteps;
    for (int n = 0; n < kSteps; ++n) {
      time_ += h;
      Eigen::Vector3d sum = force - kDamping * velocity_ - options_.posture * (position_ - start_);
      sum.z() = force.z() - kDamping * velocity_.z() - options_.press * std::min(1.0, 2.0 * time_);
      velocity_ += sum * (h / kMass);
      for (double& v : velocity_) {
        const double stopped = options_.friction * h / kMass;
        v = std::abs(v) < stopped ? 0.0 : v - std::copysign(stopped, v);
      }
      position_ += velocity_ * h;
    }
  }

  const Eigen::Vector3d& position() const { return position_; }
  const Eigen::Vector3d& velocity() const { return velocity_; }

 private:
  Options options_;
  Eigen::Vector3d start_;
  Eigen::Vector3d position_;
  Eigen::Vector3d velocity_{Eigen::Vector3d::Zero()};
  double time_{0.0};
};

}  // namespace haptrial::test
