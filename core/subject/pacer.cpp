#include "core/subject/pacer.h"

#include <algorithm>
#include <cmath>

#include "core/subject/population_schema.h"

namespace haptrial::subject {
namespace {

constexpr double kExponent = -1.0 / 3.0;       // of the power law
constexpr double kReferenceCurvature = 100.0;  // a radius of a centimetre [1/m]
constexpr double kSlowest = 0.5;               // shares of the pace that the law may reach
constexpr double kFastest = 2.0;
constexpr double kSight = 0.002;         // way over which the turn is seen [m]
constexpr double kStartTime = 0.3;       // to get going [s]
constexpr double kNoiseStep = 0.05;      // between two draws, linear in between [s]
constexpr double kCorrectionTime = 0.5;  // of the felt speed; slow against its delay [s]
constexpr double kMostCorrection = 2.0;  // [N]

}  // namespace

const Schema<Population<PaceParameters>>& pace_schema() {
  using P = PaceParameters;
  static const auto schema = make_population_schema<P>(
      "pace ", true,
      {{"pace",
        &P::pace,
        {0.001, 0.2},
        "m/s",
        "Speed of the hand along a path whose radius of curvature is 1 cm, where participants set "
        "their own speed",
        false,
        "pace"},
       {"variability",
        &P::variability,
        {0.0, 1.0},
        "",
        "Standard deviation of the intended speed within a pass, as a logarithm"},
       {"correlation",
        &P::correlation,
        {0.05, 60.0},
        "s",
        "Time over which deviations of the intended speed are alike"}});
  return schema;
}

Pacer::Pacer(const PaceParameters& person, const HandParameters& hand, RandomStream random,
             double step) noexcept
    : person_(person),
      drag_(hand.damping + hand.stiffness * hand.posture_time),
      step_(step),
      random_(random),
      noise_(kNoiseStep, person.correlation) {}

void Pacer::begin() noexcept {
  noise_.restart(random_);
  noise_now_ = noise_.next(random_);
  noise_next_ = noise_.next(random_);
  noise_age_ = 0.0;
  correction_ = 0.0;
  intended_ = 0.0;
  time_ = 0.0;
  begun_ = false;
}

Eigen::Vector3d Pacer::drive(const Eigen::Vector3d& direction, double velocity) noexcept {
  time_ += step_;
  noise_age_ += step_;
  if (noise_age_ >= kNoiseStep) {
    noise_age_ -= kNoiseStep;
    noise_now_ = noise_next_;
    noise_next_ = noise_.next(random_);
  }
  if (!begun_) {
    trend_ = direction;
    begun_ = true;
  }
  // The trend lags behind the direction by kSight of the way: their difference is the turn there.
  const double share = std::min(1.0, std::abs(velocity) * step_ / kSight);
  trend_ += share * (direction - trend_);
  const double curvature = (direction - trend_).norm() / kSight;
  const double law =
      curvature > 0.0 ? std::pow(curvature / kReferenceCurvature, kExponent) : kFastest;
  const double part = noise_age_ / kNoiseStep;
  const double noise = (1.0 - part) * noise_now_ + part * noise_next_;
  const double start = 1.0 - std::exp(-time_ / kStartTime);
  intended_ = start * person_.pace * std::exp(person_.variability * noise) *
              std::clamp(law, kSlowest, kFastest);
  correction_ += drag_ * (intended_ - velocity) * step_ / kCorrectionTime;
  correction_ = std::clamp(correction_, -kMostCorrection, kMostCorrection);
  return (drag_ * intended_ + correction_) * direction;
}

}  // namespace haptrial::subject
