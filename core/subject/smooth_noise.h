#pragma once

#include "core/base/random.h"

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

}  // namespace haptrial::subject
