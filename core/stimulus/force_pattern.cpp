#include "core/stimulus/force_pattern.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "core/base/definition/schema.h"
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

const Schema<ForcePatternParameters>& force_pattern_schema() {
  using P = ForcePatternParameters;
  static const auto schema =
      Schema<P>()
          .integer("sinusoids", &P::sinusoids, 1, 1000,
                   "Number of sinusoids whose sum is the base of a force pattern")
          .required()
          .number("max_frequency", &P::max_frequency, {0.001, 100.0}, "Hz",
                  "Highest frequency of the sinusoids of a force pattern's base")
          .required()
          .number("base_max", &P::base_max, {0.0, 100.0, true}, "N",
                  "Greatest force of a force pattern's base")
          .required()
          .integer("bumps_min", &P::bumps_min, 0, 100, "Least number of bumps of a force pattern")
          .required()
          .integer("bumps_max", &P::bumps_max, 0, 100,
                   "Greatest number of bumps of a force pattern")
          .required()
          .number("bump_max", &P::bump_max, {0.0, 100.0, true}, "N",
                  "Greatest force of a force pattern with its bumps")
          .required()
          .number("bump_width_min", &P::bump_width_min, {0.0, 60.0, true}, "s",
                  "Least width of a bump")
          .required()
          .number("bump_width_max", &P::bump_width_max, {0.0, 60.0, true}, "s",
                  "Greatest width of a bump")
          .required()
          .number("ramp", &P::ramp, {0.0, 60.0}, "s",
                  "Time over which a force pattern begins and ends")
          .required()
          .check([](Table& table, const P& p) {
            const auto at_least = [&table](const char* key, double value, double least,
                                           const char* other, const char* unit) {
              if (value < least) {
                table.reject(key, fmt::format("{:g}", value),
                             fmt::format("at least {}, {:g}{}", other, least, unit));
              }
            };
            at_least("bumps_max", p.bumps_max, p.bumps_min, "bumps_min", "");
            at_least("bump_max", p.bump_max, p.base_max, "base_max", " [N]");
            at_least("bump_width_max", p.bump_width_max, p.bump_width_min, "bump_width_min",
                     " [s]");
          });
  return schema;
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
