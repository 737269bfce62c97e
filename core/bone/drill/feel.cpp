#include "core/bone/drill/feel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "core/base/definition/schema.h"

namespace haptrial::bone {
namespace {

/// Shortened to `longest`, with its direction kept.
Eigen::Vector3d shortened(const Eigen::Vector3d& force, double longest) {
  const double length = force.norm();
  return length > longest ? Eigen::Vector3d(force * (longest / length)) : force;
}

}  // namespace

FeelParameters default_feel(double burr_radius) {
  FeelParameters p;
  const double burr_volume = 4.0 / 3.0 * std::numbers::pi * std::pow(burr_radius, 3);
  p.second_gain = std::max(4e6 / burr_radius, 1.25 * p.force_limit / burr_volume);
  p.first_gain = p.second_gain / 3.0;
  p.threshold = std::min(1e-7 * burr_radius, 0.05 * burr_volume);
  return p;
}

const Schema<FeelParameters>& feel_schema() {
  using P = FeelParameters;
  static const auto schema =
      Schema<P>()
          .number("first_gain", &P::first_gain, kPositive, "N/m^3",
                  "Force over the immersed volume just after contact; higher feels harder")
          .tunable()
          .otherwise("as fits the radius of the tool")
          .number("second_gain", &P::second_gain, kPositive, "N/m^3",
                  "Force over the immersed volume beyond the threshold; higher lets the tool sink "
                  "in less")
          .tunable()
          .otherwise("as fits the radius of the tool")
          .number("threshold", &P::threshold, kPositive, "m^3",
                  "Immersed volume at which the first gain changes to the second one")
          .tunable()
          .otherwise("as fits the radius of the tool")
          .number("force_limit", &P::force_limit, {0.0, 100.0, true}, "N",
                  "Greatest force of this contact with bone")
          .tunable()
          .number("least_agreement", &P::least_agreement, {0.0, 1.0, true}, "",
                  "Agreement of the directions in which samples push; below it the force fades")
          .tunable()
          .check([](Table& table, P& p) {
            if (p.second_gain < p.first_gain) {
              table.reject("second_gain", fmt::format("{}", p.second_gain), "first_gain or more");
            }
          });
  return schema;
}

void check(const FeelParameters& p) {
  const auto need = [](bool good, const char* name, double value, const char* allowed) {
    if (!good) {
      throw std::invalid_argument(fmt::format("feel: {} is {}; allowed: {}", name, value, allowed));
    }
  };
  need(p.first_gain > 0.0 && std::isfinite(p.first_gain), "first_gain", p.first_gain, "above 0");
  need(p.second_gain >= p.first_gain && std::isfinite(p.second_gain), "second_gain", p.second_gain,
       "first_gain or more");
  need(p.threshold > 0.0 && std::isfinite(p.threshold), "threshold", p.threshold, "above 0");
  need(p.force_limit > 0.0 && std::isfinite(p.force_limit), "force_limit", p.force_limit,
       "above 0");
  need(p.least_agreement > 0.0 && p.least_agreement <= 1.0, "least_agreement", p.least_agreement,
       "above 0, at most 1");
}

double magnitude(double volume, const FeelParameters& p) noexcept {
  const double below = std::min(volume, p.threshold);
  const double above = std::max(volume - p.threshold, 0.0);
  return std::min(p.first_gain * below + p.second_gain * above, p.force_limit);
}

Eigen::Vector3d push_force(const Contact& contact, const FeelParameters& p) noexcept {
  if (contact.samples == 0) {
    return Eigen::Vector3d::Zero();
  }
  const double agreed = std::max(contact.push.norm(), p.least_agreement * contact.volume);
  return contact.push * (magnitude(contact.volume, p) / agreed);
}

Eigen::Vector3d drag_force(const Contact& contact, const BurrParameters& burr,
                           double power) noexcept {
  // Bone holds the teeth back: the handle is pushed against the way on which they pass it.
  const double sign = burr.clockwise ? -1.0 : 1.0;
  return contact.turn * (sign * burr.tangential_gain * power);
}

Eigen::Vector3d bone_force(const Contact& contact, const FeelParameters& p,
                           const BurrParameters& burr, double power) noexcept {
  return shortened(push_force(contact, p) + drag_force(contact, burr, power), p.force_limit);
}

}  // namespace haptrial::bone
