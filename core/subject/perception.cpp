#include "core/subject/perception.h"

#include <algorithm>
#include <cmath>

#include "core/subject/noise.h"

namespace haptrial::subject {
namespace {

// Two senses without noise would have infinite weights; this floor gives them equal ones [N^2].
constexpr double kVarianceFloor = 1e-6;

int knot(double progress) noexcept {
  const int j = static_cast<int>(progress * ForceProfile::kKnots);
  return std::clamp(j, 0, ForceProfile::kKnots - 1);
}

/// Bins without a tick (a short pass) take their left neighbour's mean.
template <class Bins, class Value>
void means(const Bins& bins, Value value, std::array<double, ForceProfile::kKnots>& out) {
  double last = 0.0;
  for (int j = 0; j < ForceProfile::kKnots; ++j) {
    last = bins[j].count > 0 ? value(bins[j]) / bins[j].count : last;
    out[j] = last;
  }
}

}  // namespace

BarCalibration::BarCalibration(const SubjectParameters& person, RandomStream& random) noexcept
    : first_belief_(person.bar_misjudgement * random.normal()),
      first_variance_(person.bar_misjudgement * person.bar_misjudgement),
      belief_(first_belief_),
      variance_(first_variance_) {}

double BarCalibration::gain() const noexcept { return std::exp(belief_); }

void BarCalibration::calibrate(double observed, double spread) noexcept {
  const double total = variance_ + spread * spread;
  const double k = total > 0.0 ? variance_ / total : 0.0;
  belief_ += k * (observed - belief_);
  variance_ *= 1.0 - k;
}

void BarCalibration::relax(double share) noexcept {
  belief_ += share * (first_belief_ - belief_);
  variance_ += share * (first_variance_ - variance_);
}

void Exposure::clear() noexcept { *this = Exposure{}; }

bool Exposure::empty() const noexcept { return seen_ticks_ == 0 && felt_ticks_ == 0; }

void Exposure::see(double progress, double target_height) noexcept {
  Bin& bin = seen_[knot(progress)];
  bin.sum += target_height;
  ++bin.count;
  ++seen_ticks_;
}

void Exposure::feel(double progress, double force, double mismatch) noexcept {
  Bin& bin = felt_[knot(progress)];
  bin.sum += force;
  bin.extra += mismatch;
  ++bin.count;
  ++felt_ticks_;
}

ForceProfile Exposure::perceived(const SubjectParameters& person, BarCalibration& bar,
                                 double correlation, RandomStream& random) noexcept {
  constexpr int kKnots = ForceProfile::kKnots;
  const bool sees = seen_ticks_ > 0;
  const bool feels = felt_ticks_ > 0;
  std::array<double, kKnots> height{};
  std::array<double, kKnots> force{};
  std::array<double, kKnots> mismatch{};
  means(
      seen_, [](const Bin& b) { return b.sum; }, height);
  means(
      felt_, [](const Bin& b) { return b.sum; }, force);
  means(
      felt_, [](const Bin& b) { return b.extra; }, mismatch);

  const double felt_scale = std::exp(person.haptic_bias * random.normal());
  if (sees && feels) {
    double felt_seen = 0.0;
    double seen_seen = 0.0;
    for (int j = 0; j < kKnots; ++j) {
      const double applied = height[j] - mismatch[j];
      felt_seen += felt_scale * force[j] * applied;
      seen_seen += applied * applied;
    }
    if (felt_seen > 0.0 && seen_seen > 0.0) {
      bar.calibrate(std::log(felt_seen / seen_seen), person.haptic_bias);
    }
  }

  SmoothNoise visual_noise(1.0 / kKnots, correlation);
  SmoothNoise haptic_noise(1.0 / kKnots, correlation);
  visual_noise.restart(random);
  haptic_noise.restart(random);
  const double gain = bar.gain();
  ForceProfile profile;
  for (int j = 0; j < kKnots; ++j) {
    double weights = 0.0;
    double sum = 0.0;
    const auto add = [&](double estimate, double spread, double scale_variance) {
      const double variance =
          spread * spread + scale_variance * estimate * estimate + kVarianceFloor;
      weights += 1.0 / variance;
      sum += estimate / variance;
    };
    if (sees) {
      const double spread = person.visual_weber * height[j] + person.visual_memory_noise;
      const double estimate = gain * (height[j] + spread * visual_noise.next(random));
      add(estimate, gain * spread, bar.variance());
    }
    if (feels) {
      const double felt = force[j] * felt_scale;
      const double spread = person.haptic_weber * felt + person.haptic_memory_noise;
      const double estimate = felt + gain * mismatch[j] + spread * haptic_noise.next(random);
      add(estimate, spread, person.haptic_bias * person.haptic_bias);
    }
    profile.force[j] = weights > 0.0 ? sum / weights : 0.0;
    profile.variance[j] = weights > 0.0 ? 1.0 / weights : 0.0;
  }
  return profile;
}

}  // namespace haptrial::subject
