#pragma once

#include <Eigen/Core>

#include "core/base/random.h"
#include "core/subject/subject_parameters.h"

namespace haptrial::subject {

/// Gaussian noise of mean 0 and variance 1 that is alike over about `correlation_time`: white noise
/// through two equal first-order lags, so that it has a slope. Starts at its stationary spread.
class SmoothNoise {
 public:
  /// @param step, correlation_time  > 0, same unit
  SmoothNoise(double step, double correlation_time) noexcept;
  /// Draws a new beginning from `random`.
  void restart(RandomStream& random) noexcept;
  double next(RandomStream& random) noexcept;

 private:
  double decay_;
  double gain_;  // makes the variance 1
  double first_{0.0};
  double second_{0.0};
};

/// Involuntary force of a hand: noise in proportion to the force that is produced (Jones, Hamilton
/// and Wolpert 2002), and physiological tremor, a resonance near 9 Hz driven by white noise. One
/// step a tick. Servo thread.
class MotorNoise {
 public:
  MotorNoise(const SubjectParameters& person, double step, RandomStream random) noexcept;
  double press(double wanted) noexcept;  // with its noise [N]
  Eigen::Vector3d tremor() noexcept;     // force in W [N]

 private:
  RandomStream random_;
  double press_decay_;
  double press_gain_;
  double press_state_{0.0};
  double a1_;  // resonance: y = a1 y' + a2 y'' + gain n
  double a2_;
  double tremor_gain_;
  Eigen::Vector3d last_{Eigen::Vector3d::Zero()};
  Eigen::Vector3d before_{Eigen::Vector3d::Zero()};
};

}  // namespace haptrial::subject
