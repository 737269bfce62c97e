#include "core/stimulus/spatial_trajectory.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "core/base/definition/schema.h"
#include "core/base/random.h"

namespace haptrial::stimulus {
namespace {

// Chords of this length leave a sine of 30 cycles/m and 6 cm by at most 0.34 µm (step^2 / 8 times
// its curvature).
constexpr double kArcStep = 5e-5;  // [m]
constexpr int kCurveSamples = 4001;

std::vector<Eigen::Vector3d> random_curve(const TrajectoryParameters& p, RandomStream& random) {
  std::vector<double> z(kCurveSamples, 0.0);
  for (int i = 0; i < p.sinusoids; ++i) {
    const double omega = 2.0 * std::numbers::pi * random.uniform(0.0, p.max_spatial_frequency);
    const double phase = random.uniform(0.0, 2.0 * std::numbers::pi);
    const double offset = random.uniform(-1.0, 1.0);
    for (int k = 0; k < kCurveSamples; ++k) {
      z[k] += std::sin(omega * p.length_x * k / (kCurveSamples - 1) + phase) + offset;
    }
  }
  const auto [low, high] = std::minmax_element(z.begin(), z.end());
  const double floor = *low;
  const double scale = p.range_z / (*high - *low);
  std::vector<Eigen::Vector3d> curve(kCurveSamples);
  for (int k = 0; k < kCurveSamples; ++k) {
    curve[k] = {p.length_x * (static_cast<double>(k) / (kCurveSamples - 1) - 0.5), 0.0,
                scale * (z[k] - floor) - 0.5 * p.range_z};
  }
  return curve;
}

}  // namespace

const Schema<TrajectoryParameters>& trajectory_schema() {
  using P = TrajectoryParameters;
  const auto generated = [](const P& p) { return p.from.empty(); };
  static const auto schema =
      Schema<P>()
          .text("from", &P::from, "File with the curve to follow, relative to the definition")
          .otherwise("generated curves")
          .number("length_x", &P::length_x, {0.0, 1.0, true}, "m",
                  "Extent of a generated trajectory from left to right")
          .required()
          .only_if(generated)
          .number("range_z", &P::range_z, {0.0, 1.0, true}, "m",
                  "Extent of a generated trajectory across")
          .required()
          .only_if(generated)
          .integer("sinusoids", &P::sinusoids, 1, 1000,
                   "Number of sinusoids whose sum is a generated trajectory")
          .required()
          .only_if(generated)
          .number("max_spatial_frequency", &P::max_spatial_frequency, {0.1, 1000.0}, "cycles/m",
                  "Highest spatial frequency of the sinusoids of a generated trajectory")
          .required()
          .only_if(generated)
          .number("speed", &P::speed, {0.0, 1.0, true}, "m/s",
                  "Speed along the arc of the trajectory")
          .required();
  return schema;
}

SpatialTrajectory::SpatialTrajectory(const TrajectoryParameters& parameters, RandomStream& random)
    : speed_(parameters.speed) {
  resample(random_curve(parameters, random));
}

SpatialTrajectory::SpatialTrajectory(const std::vector<Eigen::Vector3d>& points, double speed)
    : speed_(speed) {
  if (!(speed > 0.0)) {
    throw std::invalid_argument("SpatialTrajectory: the speed must be above 0");
  }
  resample(points);
}

void SpatialTrajectory::resample(const std::vector<Eigen::Vector3d>& polyline) {
  std::vector<double> arc(polyline.size(), 0.0);
  for (std::size_t i = 1; i < polyline.size(); ++i) {
    arc[i] = arc[i - 1] + (polyline[i] - polyline[i - 1]).norm();
  }
  length_ = arc.empty() ? 0.0 : arc.back();
  if (!(length_ > 0.0) || !std::isfinite(length_)) {
    throw std::invalid_argument("SpatialTrajectory: the points must span a finite curve");
  }
  const auto steps = std::max<std::size_t>(1, static_cast<std::size_t>(length_ / kArcStep));
  points_.resize(steps + 1);
  std::size_t segment = 1;
  for (std::size_t k = 0; k <= steps; ++k) {
    const double s = length_ * static_cast<double>(k) / static_cast<double>(steps);
    while (segment + 1 < arc.size() && arc[segment] < s) {
      ++segment;
    }
    const double span = arc[segment] - arc[segment - 1];
    const double t = span > 0.0 ? std::clamp((s - arc[segment - 1]) / span, 0.0, 1.0) : 1.0;
    points_[k] = (1.0 - t) * polyline[segment - 1] + t * polyline[segment];
  }
}

PointState SpatialTrajectory::at(double time) const noexcept {
  const double steps = static_cast<double>(points_.size() - 1);
  const double u = time * speed_ / length_ * steps;
  if (!(u > 0.0)) {
    return {points_.front(), Eigen::Vector3d::Zero()};
  }
  if (u >= steps) {
    return {points_.back(), Eigen::Vector3d::Zero()};
  }
  const auto i = static_cast<std::size_t>(u);
  const double t = u - static_cast<double>(i);
  const Eigen::Vector3d chord = points_[i + 1] - points_[i];
  return {points_[i] + t * chord, chord * (speed_ * steps / length_)};
}

}  // namespace haptrial::stimulus
