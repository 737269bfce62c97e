#include "analysis/device/excitation.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace haptrial::analysis {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr long kHold = 150;   // ticks of a hold at 1 kHz: a third is the way to it
constexpr long kRamp = 50;    // [ticks at 1 kHz]
constexpr long kSettle = 30;  // [ticks at 1 kHz]
constexpr int kTones = 24;
constexpr double kBias = 0.55, kSwing = 0.4;  // of the greatest force
constexpr double kSlow = 8.0, kFast = 3.0;    // along each axis [s]
constexpr double kSlowPeriod = 4.0;           // [s]
constexpr double kFastFrequency = 3.0;        // [Hz]
constexpr double kFree = 12.0;                // along each axis [s]
constexpr double kFreeForce = 5.0;            // [N]
// The slow ones show friction and dead zone, the fast ones delay and resonance.
constexpr double kFreeTones[] = {0.7, 1.3, 2.3, 3.7, 5.3, 7.9, 13.0, 23.0, 41.0, 67.0};  // [Hz]
constexpr double kFreeShare = 0.13;  // of the force, each; all together stay below it
constexpr double kCentring = 50.0;   // [N/m]
constexpr double kCalming = 2.0;     // [N·s/m]

/// From 0 to 1 without a jump of velocity or acceleration.
double smooth(double s) {
  s = std::clamp(s, 0.0, 1.0);
  return s * s * s * (10.0 + s * (6.0 * s - 15.0));
}

}  // namespace

Excitation::Excitation(double rate, double max_force, DrivenAxes axes, double reach)
    : rate_(rate),
      max_force_(max_force),
      axes_(std::move(axes)),
      reach_(reach),
      period_(std::lround(rate)) {
  const auto lacks = [this](int axis) { return std::ranges::find(axes_, axis) == axes_.end(); };
  for (int x = -1; x <= 1; ++x) {
    for (int y = -1; y <= 1; ++y) {
      for (int z = -1; z <= 1; ++z) {
        const int first = x != 0 ? x : y != 0 ? y : z;
        const bool driven = (x == 0 || !lacks(0)) && (y == 0 || !lacks(1)) && (z == 0 || !lacks(2));
        if (first > 0 && driven) {
          directions_.push_back(Eigen::Vector3d(x, y, z).normalized());
        }
      }
    }
  }
  grid_levels_ = {0.0};
  constexpr double kShares[] = {0.02, 0.05, 0.1, 0.2, 0.35, 0.5, 0.75, 1.0};
  constexpr int kCount = std::size(kShares);
  for (const double sign : {1.0, -1.0}) {
    for (int i = 0; i < 2 * kCount; ++i) {  // up and down again, so that friction shows both ways
      grid_levels_.push_back(sign * max_force * kShares[i < kCount ? i : 2 * kCount - 1 - i]);
    }
    grid_levels_.push_back(0.0);
  }
  const long hold = scaled(kHold);
  for (std::size_t axis = 0; axis < directions_.size(); ++axis) {
    for (std::size_t i = 0; i < grid_levels_.size(); ++i) {
      const long start = static_cast<long>(axis * grid_levels_.size() + i) * hold;
      holds_.push_back({static_cast<int>(axis), grid_levels_[i], start + scaled(kRamp + kSettle)});
    }
  }
  const double top = 0.45 * rate;
  for (int i = 0; i < kTones; ++i) {
    const int f = static_cast<int>(std::lround(2.0 * std::pow(top / 2.0, i / (kTones - 1.0))));
    if (frequencies_.empty() || f > frequencies_.back()) {
      frequencies_.push_back(f);
    }
  }
  wave_.resize(static_cast<std::size_t>(period_));
  double peak = 0.0;
  const auto tones = static_cast<double>(frequencies_.size());
  for (long t = 0; t < period_; ++t) {
    double sum = 0.0;
    for (std::size_t i = 0; i < frequencies_.size(); ++i) {
      const double phase = -kPi * static_cast<double>(i * (i + 1)) / tones;  // Schroeder's
      sum += std::cos(2.0 * kPi * frequencies_[i] * static_cast<double>(t) / rate + phase);
    }
    wave_[static_cast<std::size_t>(t)] = sum;
    peak = std::max(peak, std::abs(sum));
  }
  for (double& value : wave_) {
    value /= peak;
  }
}

Eigen::Vector3d Excitation::axis_at(long tick, long per_axis) const noexcept {
  const long at = std::min(tick / per_axis, count_of_axes() - 1);
  return Eigen::Vector3d::Unit(axes_[static_cast<std::size_t>(at)]);
}

double Excitation::free_force() const noexcept { return std::min(kFreeForce, 0.5 * max_force_); }

long Excitation::scaled(long at_1_khz) const noexcept {
  return std::lround(1e-3 * rate_ * static_cast<double>(at_1_khz));
}

long Excitation::ticks(CertificatePart part) const noexcept {
  switch (part) {
    case CertificatePart::kRest:
      return scaled(2000);
    case CertificatePart::kGrid:
      return static_cast<long>(holds_.size()) * scaled(kHold);
    case CertificatePart::kFrequency:
      return count_of_axes() * (1 + kPeriods) * period_;
    case CertificatePart::kMove:
      return count_of_axes() * std::lround((kSlow + kFast) * rate_);
    case CertificatePart::kFree:
    case CertificatePart::kLoaded:
      return count_of_axes() * std::lround(kFree * rate_);
    case CertificatePart::kWall:
    case CertificatePart::kDone:
      break;
  }
  return 0;
}

Eigen::Vector3d Excitation::command(CertificatePart part, long tick) const noexcept {
  if (part == CertificatePart::kGrid) {
    const long hold = scaled(kHold);
    const auto at = static_cast<std::size_t>(tick / hold);
    if (at >= holds_.size()) {
      return Eigen::Vector3d::Zero();
    }
    const GridHold& now = holds_[at];
    const bool first = at == 0 || holds_[at - 1].axis != now.axis;
    const double from = first ? 0.0 : holds_[at - 1].level;
    const double way =
        smooth(static_cast<double>(tick % hold) / static_cast<double>(scaled(kRamp)));
    return (from + (now.level - from) * way) * directions_[static_cast<std::size_t>(now.axis)];
  }
  if (part == CertificatePart::kFrequency) {
    const double wave = wave_[static_cast<std::size_t>(tick % period_)];
    const double since = static_cast<double>(tick % ((1 + kPeriods) * period_)) / rate_;
    return max_force_ * smooth(4.0 * since) * (kBias + kSwing * wave) *
           axis_at(tick, (1 + kPeriods) * period_);
  }
  if (part == CertificatePart::kFree || part == CertificatePart::kLoaded) {
    const double t = static_cast<double>(tick % axis_ticks(part)) / rate_;
    double sum = 0.0;
    for (std::size_t i = 0; i < std::size(kFreeTones); ++i) {
      sum += std::sin(2.0 * kPi * kFreeTones[i] * t + static_cast<double>(i * i));
    }
    return free_force() * centred(part, tick) * kFreeShare * sum * axis_at(tick, axis_ticks(part));
  }
  return Eigen::Vector3d::Zero();
}

Eigen::Vector3d Excitation::centring(CertificatePart part, long tick,
                                     const PointState& tool) const noexcept {
  const Eigen::Vector3d axis = axis_at(tick, axis_ticks(part));
  const double stiffness = std::max(kCentring, free_force() / reach_);
  const double force = -stiffness * axis.dot(tool.position) - kCalming * axis.dot(tool.velocity);
  return centred(part, tick) * force * axis;
}

double Excitation::centred(CertificatePart part, long tick) const noexcept {
  const double t = static_cast<double>(tick % axis_ticks(part)) / rate_;
  return smooth(2.0 * t) * smooth(2.0 * (kFree - t));
}

int Excitation::moved_axis(CertificatePart part, long tick) const noexcept {
  Eigen::Index axis = 0;
  axis_at(tick, axis_ticks(part)).maxCoeff(&axis);
  return static_cast<int>(axis);
}

Eigen::Vector3d Excitation::position(CertificatePart part, long tick, double reach) const noexcept {
  if (part != CertificatePart::kMove) {
    return Eigen::Vector3d::Zero();
  }
  const double t = static_cast<double>(tick % axis_ticks(part)) / rate_;
  double way = 0.0;
  if (t < kSlow) {
    const double rise = smooth(2.0 * t) * smooth(2.0 * (kSlow - t));
    way = rise * std::sin(2.0 * kPi * t / kSlowPeriod);
  } else {
    const double rise = smooth(2.0 * (t - kSlow)) * smooth(2.0 * (kSlow + kFast - t));
    way = 0.4 * rise * std::sin(2.0 * kPi * kFastFrequency * (t - kSlow));
  }
  return reach * way * axis_at(tick, axis_ticks(part));
}

}  // namespace haptrial::analysis
