#include "core/subject/smooth_noise.h"

#include <cmath>

namespace haptrial::subject {

SmoothNoise::SmoothNoise(double step, double correlation_time) noexcept
    : decay_(std::exp(-step / correlation_time)) {
  // Variance of white noise through 1 / (1 - d z)^2 is (1 + d^2) / (1 - d^2)^3.
  const double d2 = decay_ * decay_;
  gain_ = std::sqrt((1.0 - d2) * (1.0 - d2) * (1.0 - d2) / (1.0 + d2));
}

void SmoothNoise::restart(RandomStream& random) noexcept {
  // The stationary state: var(first) = 1 / (1 - d^2), cov = d-weighted; drawn by its Cholesky
  // factor.
  const double d2 = decay_ * decay_;
  const double first_variance = 1.0 / (1.0 - d2);
  const double covariance = 1.0 / ((1.0 - d2) * (1.0 - d2));
  const double second_variance = 1.0 / (gain_ * gain_);
  const double a = random.normal();
  const double b = random.normal();
  first_ = std::sqrt(first_variance) * a;
  const double slope = covariance / first_variance;
  second_ = slope * first_ + std::sqrt(second_variance - slope * covariance) * b;
}

double SmoothNoise::next(RandomStream& random) noexcept {
  first_ = decay_ * first_ + random.normal();
  second_ = decay_ * second_ + first_;
  return gain_ * second_;
}

}  // namespace haptrial::subject
