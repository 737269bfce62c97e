#include "core/scene/relief.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "core/base/random.h"
#include "core/base/require.h"

namespace haptrial::scene {
namespace {

using Eigen::Vector3d;

constexpr double kTwoPi = 2.0 * std::numbers::pi;

/// Bounds of a relief that hold anywhere on it.
struct Bound {
  double height, steepest;
};

void lay_height_on(double height, const Vector3d& slope, double weight, const Bound& bound,
                   ReliefHere& relief, FieldState& state) noexcept {
  relief.height += weight * height;
  relief.slope += weight * slope;
  relief.steepest += weight * bound.steepest;
  relief.highest += weight * bound.height;
  state.depth = weight * height;
}

}  // namespace

ReliefBound GratingParameters::relief_bound() const {
  const Grating law(*this, {});
  return {law.steepest(), law.most_curved(), law.steepest(), law.most_curved()};
}

/// The band is filled evenly: <w²> and <w⁴> are its means. The crests of all waves hardly ever
/// meet.
ReliefBound TextureParameters::relief_bound() const {
  const Texture law(*this, {});
  const auto mean_power = [&](double power) {
    return std::pow(kTwoPi, power) *
           (std::pow(highest, power + 1.0) - std::pow(lowest, power + 1.0)) /
           ((power + 1.0) * (highest - lowest));
  };
  return {law.steepest(), law.most_curved(), roughness * std::sqrt(mean_power(2.0)),
          roughness * std::sqrt(mean_power(4.0))};
}

Grating::Grating(const GratingParameters& p, const Setting&)
    : amplitude_(p.amplitude),
      phase_(kTwoPi * p.phase),
      rounded_(p.profile == GratingParameters::Profile::kRounded) {
  require(p.direction.allFinite() && p.direction.norm() > 0.0,
          "Grating: direction must be finite and not zero");
  require(std::isfinite(p.amplitude) && p.amplitude >= 0.0,
          "Grating: amplitude must be finite and at least 0");
  require(std::isfinite(p.period) && p.period > 0.0, "Grating: period must be finite and above 0");
  require(std::isfinite(p.phase), "Grating: phase must be finite");
  wave_ = kTwoPi / p.period * p.direction.normalized();
}

void Grating::add(const Vector3d& p, double weight, ReliefHere& relief,
                  FieldState& state) const noexcept {
  const double angle = wave_.dot(p) + phase_;
  double height = std::sin(angle);
  double slope = std::cos(angle);
  if (rounded_) {
    static const double scale = 1.0 / std::tanh(kRoundedSharpness);
    const double t = std::tanh(kRoundedSharpness * height);
    slope *= scale * kRoundedSharpness * (1.0 - t * t);
    height = scale * t;
  }
  lay_height_on(amplitude_ * height, amplitude_ * slope * wave_, weight, {amplitude_, steepest()},
                relief, state);
}

double Grating::ridges(const Vector3d& way) const noexcept {
  return std::abs(wave_.dot(way)) / kTwoPi;
}

double Grating::steepest() const noexcept {
  const double sine = amplitude_ * wave_.norm();
  return rounded_ ? sine * kRoundedSharpness / std::tanh(kRoundedSharpness) : sine;
}

double Grating::most_curved() const noexcept {
  // tanh(s sin x)'' = s (1 - t^2) (-sin x - 2 s t cos^2 x), at most s (1 + 2 s 0.385): t - t^3.
  const double sine = amplitude_ * wave_.squaredNorm();
  const double s = kRoundedSharpness;
  return rounded_ ? sine * s * (1.0 + 2.0 * s * 0.385) / std::tanh(s) : sine;
}

Texture::Texture(const TextureParameters& p, const Setting&) {
  require(p.normal.allFinite() && p.normal.norm() > 0.0,
          "Texture: normal must be finite and not zero");
  require(std::isfinite(p.roughness) && p.roughness >= 0.0,
          "Texture: roughness must be finite and at least 0");
  require(std::isfinite(p.lowest) && p.lowest > 0.0, "Texture: lowest must be finite and above 0");
  require(std::isfinite(p.highest) && p.highest > p.lowest,
          "Texture: highest must be finite and above lowest");
  const Vector3d n = p.normal.normalized();
  const Vector3d a =
      n.cross(std::abs(n.x()) < 0.9 ? Vector3d::UnitX() : Vector3d::UnitY()).normalized();
  const Vector3d b = n.cross(a);
  RandomStream random(p.seed, "texture");
  amplitude_ = p.roughness * std::sqrt(2.0 / kWaves);
  for (std::size_t i = 0; i < kWaves; ++i) {
    const double share = (static_cast<double>(i) + random.uniform()) / kWaves;
    const double wave = kTwoPi * (p.lowest + share * (p.highest - p.lowest));
    const double heading = random.uniform(0.0, kTwoPi);
    waves_[i] = wave * (std::cos(heading) * a + std::sin(heading) * b);
    phases_[i] = random.uniform(0.0, kTwoPi);
    steepest_ += amplitude_ * wave;
    most_curved_ += amplitude_ * wave * wave;
  }
}

double Texture::ridges(const Vector3d& way) const noexcept {
  double squares = 0.0;
  for (const Vector3d& wave : waves_) {
    squares += wave.dot(way) * wave.dot(way);
  }
  return std::sqrt(squares / kWaves) / kTwoPi;
}

void Texture::add(const Vector3d& p, double weight, ReliefHere& relief,
                  FieldState& state) const noexcept {
  double height = 0.0;
  Vector3d slope = Vector3d::Zero();
  for (std::size_t i = 0; i < kWaves; ++i) {
    const double angle = waves_[i].dot(p) + phases_[i];
    height += std::sin(angle);
    slope += std::cos(angle) * waves_[i];
  }
  lay_height_on(amplitude_ * height, amplitude_ * slope, weight,
                {amplitude_ * static_cast<double>(kWaves), steepest_}, relief, state);
}

}  // namespace haptrial::scene
