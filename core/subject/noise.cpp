#include "core/subject/noise.h"

#include <cmath>
#include <numbers>

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

namespace {
constexpr double kTremorBandwidth = 2.0;  // half width of the spectral peak [Hz]
}

MotorNoise::MotorNoise(const SubjectParameters& person, double step, RandomStream random) noexcept
    : random_(random), press_decay_(std::exp(-step / person.force_noise_time)) {
  press_gain_ = person.force_noise * std::sqrt(1.0 - press_decay_ * press_decay_);
  const double radius = std::exp(-2.0 * std::numbers::pi * kTremorBandwidth * step);
  a1_ = 2.0 * radius * std::cos(2.0 * std::numbers::pi * person.tremor_frequency * step);
  a2_ = -radius * radius;
  // Variance of an AR(2) process with unit noise, inverted so that the root mean square is
  // `tremor`.
  const double variance = (1.0 - a2_) / ((1.0 + a2_) * ((1.0 - a2_) * (1.0 - a2_) - a1_ * a1_));
  tremor_gain_ = person.tremor / std::sqrt(variance);
}

double MotorNoise::press(double wanted) noexcept {
  press_state_ = press_decay_ * press_state_ + press_gain_ * random_.normal();
  return wanted * (1.0 + press_state_);
}

Eigen::Vector3d MotorNoise::tremor() noexcept {
  const Eigen::Vector3d drive(random_.normal(), random_.normal(), random_.normal());
  const Eigen::Vector3d next = a1_ * last_ + a2_ * before_ + tremor_gain_ * drive;
  before_ = last_;
  last_ = next;
  return next;
}

}  // namespace haptrial::subject
