#include "core/stimulus/force_pattern.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "core/base/definition/table.h"
#include "core/base/random.h"

namespace haptrial::stimulus {
namespace {

// Linear in between: within 0.01 mN of a 0.2 Hz sinusoid and 0.14 mN of a bump of 12 N and 0.6 s
// (step^2 / 8 times the second derivative).
constexpr double kTimeStep = 0.002;  // [s]

void add_sinusoids(const ForcePatternParameters& p, double duration, RandomStream& random,
                   std::vector<double>& forces) {
  for (int i = 0; i < p.sinusoids; ++i) {
    const double omega = 2.0 * std::numbers::pi * random.uniform(0.0, p.max_frequency);
    const double phase = random.uniform(0.0, 2.0 * std::numbers::pi);
    const double offset = random.uniform(-1.0, 1.0);
    for (std::size_t k = 0; k < forces.size(); ++k) {
      const double t = duration * static_cast<double>(k) / static_cast<double>(forces.size() - 1);
      forces[k] += std::sin(omega * t + phase) + offset;
    }
  }
  const auto [low, high] = std::minmax_element(forces.begin(), forces.end());
  const double floor = *low;
  const double scale = *high > *low ? p.base_max / (*high - *low) : 0.0;
  for (double& f : forces) {
    f = scale * (f - floor);
  }
}

void blend_bump(const ForcePatternParameters& p, double duration, RandomStream& random,
                std::vector<double>& forces) {
  const double width = std::min(random.uniform(p.bump_width_min, p.bump_width_max), duration);
  const double centre = random.uniform(0.5 * width, duration - 0.5 * width);
  const double steps = static_cast<double>(forces.size() - 1);
  const double base = forces[static_cast<std::size_t>(centre / duration * steps)];
  const double peak = random.uniform(base, p.bump_max);
  for (std::size_t k = 0; k < forces.size(); ++k) {
    const double u = 2.0 * (duration * static_cast<double>(k) / steps - centre) / width;
    const double weight = std::max(0.0, 1.0 - u * u);
    forces[k] += weight * (peak - forces[k]);
  }
}

void ramp_ends(double ramp, double duration, std::vector<double>& forces) {
  for (std::size_t k = 0; k < forces.size(); ++k) {
    const double t = duration * static_cast<double>(k) / static_cast<double>(forces.size() - 1);
    const double edge = std::min(t, duration - t);
    forces[k] *= ramp > 0.0 ? std::clamp(edge / ramp, 0.0, 1.0) : 1.0;
  }
}

}  // namespace

ForcePatternParameters read_force_pattern_parameters(Table& table) {
  ForcePatternParameters p;
  p.sinusoids = static_cast<int>(table.integer("sinusoids", 1, 1000));
  p.max_frequency = table.number("max_frequency", {0.001, 100.0}, "Hz");
  p.base_max = table.number("base_max", {0.0, 100.0, true}, "N");
  p.bumps_min = static_cast<int>(table.integer("bumps_min", 0, 100));
  p.bumps_max = static_cast<int>(table.integer("bumps_max", p.bumps_min, 100));
  p.bump_max = table.number("bump_max", {p.base_max, 100.0, false}, "N");
  p.bump_width_min = table.number("bump_width_min", {0.0, 60.0, true}, "s");
  p.bump_width_max = table.number("bump_width_max", {p.bump_width_min, 60.0, false}, "s");
  p.ramp = table.number("ramp", {0.0, 60.0, false}, "s");
  return p;
}

ForcePattern::ForcePattern(const ForcePatternParameters& parameters, double duration,
                           RandomStream& random)
    : forces_(static_cast<std::size_t>(std::ceil(duration / kTimeStep)) + 1), duration_(duration) {
  add_sinusoids(parameters, duration, random, forces_);
  const auto spread = static_cast<std::uint64_t>(parameters.bumps_max - parameters.bumps_min + 1);
  const int bumps = parameters.bumps_min + static_cast<int>(random.below(spread));
  for (int i = 0; i < bumps; ++i) {
    blend_bump(parameters, duration, random, forces_);
  }
  ramp_ends(parameters.ramp, duration, forces_);
}

ForcePattern::ForcePattern(std::vector<double> forces, double duration)
    : forces_(std::move(forces)), duration_(duration) {
  if (forces_.size() < 2 || !(duration > 0.0)) {
    throw std::invalid_argument("ForcePattern: at least two forces and a duration above 0");
  }
}

double ForcePattern::at(double time) const noexcept {
  const double steps = static_cast<double>(forces_.size() - 1);
  const double u = time / duration_ * steps;
  if (!(u > 0.0)) {
    return forces_.front();
  }
  if (u >= steps) {
    return forces_.back();
  }
  const auto i = static_cast<std::size_t>(u);
  return forces_[i] + (u - static_cast<double>(i)) * (forces_[i + 1] - forces_[i]);
}

double ForcePattern::peak() const noexcept {
  return *std::max_element(forces_.begin(), forces_.end());
}

}  // namespace haptrial::stimulus
