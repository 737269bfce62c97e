#pragma once

#include <Eigen/Core>
#include <cmath>
#include <numbers>

namespace haptrial::scene {

/// First-order low-pass of a vector:
///
///     y += a (x - y),   a = 1 - exp(-2 pi f_c / rate)
///
/// It begins at its first input, so that switching on makes no transient. Servo thread.
class LowPass {
 public:
  /// @param cutoff  f_c > 0 [Hz], infinite for no filter
  LowPass(double cutoff, double rate) noexcept
      : share_(std::isinf(cutoff) ? 1.0 : 1.0 - std::exp(-2.0 * std::numbers::pi * cutoff / rate)) {
  }

  void start(const Eigen::Vector3d& x) noexcept { y_ = x; }
  const Eigen::Vector3d& next(const Eigen::Vector3d& x) noexcept { return y_ += share_ * (x - y_); }
  void adopt(const LowPass& before) noexcept { y_ = before.y_; }

 private:
  double share_;
  Eigen::Vector3d y_{Eigen::Vector3d::Zero()};
};

}  // namespace haptrial::scene
