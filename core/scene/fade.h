#pragma once

namespace haptrial::scene {

/// The weight of a field between 0 and 1: continuous with its slope, also if the field is switched
/// again before a fade is over. With s(u) = 3 u^2 - 2 u^3 and the time t since the last switch,
///
///     w(t) = (1 - s(t/D)) (w_0 + w_0' a t / (a + t)) + s(t/D) target
///
/// a is the time that w_0' would take to reach 0 or 1, so w stays within them. A duration of 0
/// steps. Servo thread.
class Fade {
 public:
  /// Towards 1 or 0. @param duration  D >= 0 [s]
  void turn(bool on, double duration) noexcept;
  /// `dt` later. @returns the weight
  double next(double dt) noexcept;

  double weight() const noexcept { return weight_; }
  bool on() const noexcept { return target_ > 0.0; }
  bool over() const noexcept { return time_ >= duration_; }
  double left() const noexcept { return over() ? 0.0 : duration_ - time_; }  // [s]

 private:
  double slope() const noexcept;

  double begin_{0.0};        // w_0
  double begin_slope_{0.0};  // w_0' [1/s]
  double room_{0.0};         // a [s]
  double target_{0.0};
  double duration_{0.0};
  double time_{0.0};
  double weight_{0.0};
};

}  // namespace haptrial::scene
