#pragma once

#include <Eigen/Core>
#include <cmath>
#include <limits>
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

/// How far a hand is ahead of where it has been, behind a low-pass:
///
///     a = p - p_slow,   f_c = 2 Hz
///
/// It tells a hand that moves over ridges or detents from one that swings within one of them. A
/// hand that moves on by 6.3 periods a second is half a period ahead. One that swings in a groove
/// is not, since half a period is the way from the middle of a groove to its edge. Servo thread.
class OwnWay {
 public:
  explicit OwnWay(double rate) noexcept : velocity_(kSlow, rate) {}

  void start(const Eigen::Vector3d& velocity) noexcept { velocity_.start(velocity); }
  void adopt(const OwnWay& before) noexcept { velocity_.adopt(before.velocity_); }
  /// @param velocity  of the hand [m/s]  @returns a [m]
  Eigen::Vector3d next(const Eigen::Vector3d& velocity) noexcept {
    return velocity_.next(velocity) / (2.0 * std::numbers::pi * kSlow);
  }

 private:
  static constexpr double kSlow = 2.0;  // f_c [Hz]
  LowPass velocity_;
};

/// Whether a hand passes ridges or detents, so that their force is meant to alternate: it is half a
/// period ahead, or was 0.3 s ago, as a hand that strokes to and fro is when it turns.
class PassingWatch {
 public:
  /// @param periods  that the hand is ahead by  @param dt  since the tick before [s]
  bool look(double periods, double dt) noexcept {
    constexpr double kAhead = 0.5;
    constexpr double kTurning = 0.3;  // [s]
    since_ = periods > kAhead ? 0.0 : since_ + dt;
    return since_ < kTurning;
  }

 private:
  double since_{std::numeric_limits<double>::infinity()};  // it was ahead [s]
};

}  // namespace haptrial::scene
