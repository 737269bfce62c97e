#include "core/control/damping_governor.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "core/base/longer.h"

namespace haptrial::control {
namespace {

constexpr double kBandLow = 25.0;       // a hand's own movement ends below [Hz]
constexpr double kBandHigh = 80.0;      // above there is mostly the noise of the velocity [Hz]
constexpr double kLoud = 1.0;           // [N]
constexpr double kQuiet = 0.5;          // [N]
constexpr double kShareOfSpeed = 0.22;  // of an even 13 Hz; a hand's own movement has less
constexpr double kBandMemory = 0.02;    // of an amplitude: one period of 50 Hz [s]
constexpr double kSpeedMemory = 0.05;   // [s]
constexpr double kLettingGo = 0.004;    // [s]
constexpr double kGivingBack = 0.4;     // from nothing to all of it [s]
constexpr double kTryingAnew = 30.0;    // of what proved too much, from nothing to all of it [s]
constexpr double kBelowTooMuch = 0.7;   // of the share at which the handle began to oscillate

double filter_gain(double frequency, double period) {
  return 1.0 - std::exp(-2.0 * std::numbers::pi * frequency * period);
}

/// The larger of both lengths.
double fading_peak(double faded, const Eigen::Vector3d& now) {
  return longer(now, faded) ? now.norm() : faded;
}

}  // namespace

DampingGovernor::DampingGovernor(double damping, const HandleLoop& loop)
    : damping_(damping), period_(1.0 / loop.rate) {
  if (!(damping >= 0.0) || !(loop.handle_mass > 0.0 && loop.rate > 0.0) ||
      loop.velocity_window < 2) {
    throw std::invalid_argument(
        "DampingGovernor: handle_mass and rate must be above 0, damping at least 0 and "
        "velocity_window at least 2");
  }
  least_ = damping > 0.0 ? damping_of_bare_handle(damping, loop) / damping : 1.0;
  share_ = least_;
  high_gain_ = filter_gain(kBandLow, period_);
  low_gain_ = filter_gain(kBandHigh, period_);
  band_fade_ = std::exp(-period_ / kBandMemory);
  speed_fade_ = std::exp(-period_ / kSpeedMemory);
}

double DampingGovernor::share(const Eigen::Vector3d& velocity) noexcept {
  watch(velocity);
  const double loudness = damping_ * band_amplitude_;
  if (loudness > kLoud && band_amplitude_ > kShareOfSpeed * speed_amplitude_) {
    if (quiet_ && fell_) {  // again, on the way up
      ceiling_ = std::max(least_, std::min(ceiling_, kBelowTooMuch * share_));
    }
    fell_ = true;
    quiet_ = false;
    share_ = std::max(least_, share_ * (1.0 - std::min(1.0, period_ / kLettingGo)));
  } else if (loudness < kQuiet) {
    quiet_ = true;
    ceiling_ = std::min(1.0, ceiling_ + period_ / kTryingAnew);
    share_ = std::min(ceiling_, share_ + period_ / kGivingBack);
    fell_ = fell_ && share_ < 1.0;
  }
  return share_;
}

void DampingGovernor::watch(const Eigen::Vector3d& velocity) noexcept {
  Eigen::Vector3d rest = velocity.allFinite() ? velocity : Eigen::Vector3d(Eigen::Vector3d::Zero());
  if (!std::exchange(begun_, true)) {
    slow_[0] = rest;  // a hand that moves already is no step of velocity
  }
  speed_amplitude_ = fading_peak(speed_fade_ * speed_amplitude_, rest);
  for (Eigen::Vector3d& slow : slow_) {
    slow += high_gain_ * (rest - slow);
    rest -= slow;
  }
  band_ += low_gain_ * (rest - band_);
  band_amplitude_ = fading_peak(band_fade_ * band_amplitude_, band_);
}

}  // namespace haptrial::control
