#include "core/scene/vibration.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/random.h"
#include "core/base/require.h"

namespace haptrial::scene {
namespace {

using Eigen::Vector3d;

constexpr double kFullTurn = 2.0 * std::numbers::pi;

Vector3d unit(const Vector3d& direction) {
  require(direction.allFinite() && direction.norm() > 0.0,
          "Vibration: direction must be finite and not zero");
  return direction.normalized();
}

void require_audible(double frequency, double rate) {
  require(frequency > 0.0 && frequency < 0.5 * rate,
          "Vibration: frequency must be above 0 and below half the loop's rate");
}

}  // namespace

SineVibration::SineVibration(const SineVibrationParameters& p, const Setting& setting)
    : amplitude_(p.amplitude * unit(p.direction), setting.rate),
      angular_(kFullTurn * p.frequency),
      first_phase_(p.phase),
      phase_(p.phase) {
  require(std::isfinite(p.amplitude) && p.amplitude >= 0.0,
          "Vibration: amplitude must be finite and at least 0");
  require(std::isfinite(p.phase), "Vibration: phase must be finite");
  require_audible(p.frequency, setting.rate);
}

Vector3d SineVibration::force(const Felt& felt, FieldState& state) noexcept {
  time_ = felt.time;
  return state.stimulus = std::sin(angular_ * felt.time + phase_) * amplitude_.next();
}

void SineVibration::adopt(const SineVibration& before) noexcept {
  phase_ = before.phase_;
  if (angular_ != before.angular_) {
    phase_ += (before.angular_ - angular_) * before.time_;
  }
  amplitude_.adopt(before.amplitude_);
}

NoiseVibration::NoiseVibration(const NoiseVibrationParameters& p, const Setting& setting)
    : amplitude_(p.rms * std::sqrt(2.0 / kTones) * unit(p.direction), setting.rate) {
  require(std::isfinite(p.rms) && p.rms >= 0.0, "Vibration: rms must be finite and at least 0");
  require_audible(p.lowest, setting.rate);
  require_audible(p.highest, setting.rate);
  require(p.highest > p.lowest, "Vibration: highest must be above lowest");
  RandomStream random(p.seed, "vibration");
  for (std::size_t i = 0; i < kTones; ++i) {
    const double share = (static_cast<double>(i) + random.uniform()) / kTones;
    const double turn = kFullTurn * (p.lowest + share * (p.highest - p.lowest)) / setting.rate;
    const double phase = random.uniform(0.0, kFullTurn);
    first_.sine[i] = std::sin(phase);
    first_.cosine[i] = std::cos(phase);
    step_.sine[i] = std::sin(turn);
    step_.cosine[i] = std::cos(turn);
  }
  phasors_ = first_;
}

Vector3d NoiseVibration::force(const Felt&, FieldState& state) noexcept {
  double sum = 0.0;
  for (std::size_t i = 0; i < kTones; ++i) {
    const double s = phasors_.sine[i];
    const double c = phasors_.cosine[i];
    sum += s;
    phasors_.sine[i] = s * step_.cosine[i] + c * step_.sine[i];
    phasors_.cosine[i] = c * step_.cosine[i] - s * step_.sine[i];
  }
  return state.stimulus = sum * amplitude_.next();
}

Tap::Tap(const TapParameters& p, const Setting& setting)
    : amplitude_(p.amplitude),
      angular_(kFullTurn * p.frequency),
      decay_(p.decay),
      on_surface_(!p.on.empty()),
      direction_(unit(p.direction)) {
  require(std::isfinite(p.amplitude) && p.amplitude >= 0.0,
          "Tap: amplitude must be finite and at least 0");
  require(std::isfinite(p.decay) && p.decay > 0.0, "Tap: decay must be finite and above 0");
  require_audible(p.frequency, setting.rate);
}

void Tap::start(const PointState&) noexcept {
  strength_ = on_surface_ ? 0.0 : amplitude_;
  began_ = 0.0;
  touching_ = false;
}

Vector3d Tap::force(const Felt& felt, FieldState& state) noexcept {
  if (felt.surface != nullptr) {
    const bool touches = felt.surface->pressing > 0.0;
    if (touches && !touching_) {
      strength_ = amplitude_ * std::max(felt.surface->closing_speed, 0.0);
      direction_ = felt.surface->normal;
      began_ = felt.time;
    }
    touching_ = touches;
  }
  const double t = felt.time - began_;
  const double envelope = strength_ * std::exp(-t / decay_);
  return state.stimulus = envelope * std::sin(angular_ * t) * direction_;
}

void Tap::adopt(const Tap& before) noexcept {
  strength_ = before.strength_;
  began_ = before.began_;
  touching_ = before.touching_;
  direction_ = before.direction_;
}

}  // namespace haptrial::scene
