#include "core/psychometric/function/axis.h"

#include <cmath>
#include <limits>
#include <numbers>

namespace haptrial::psychometric {
namespace {

/// x changes by this much when the logarithm to the base e changes by 1.
double units_a_logarithm(Scale scale) noexcept {
  switch (scale) {
    case Scale::kLog10:
      return std::numbers::log10e;
    case Scale::kDecibel:
      return 20.0 * std::numbers::log10e;
    default:
      return 1.0;
  }
}

}  // namespace

double Axis::at(double level) const noexcept {
  const double distance = level - origin;
  if (scale == Scale::kLinear) {
    return distance;
  }
  if (distance <= 0.0) {
    return -std::numeric_limits<double>::infinity();
  }
  return scale == Scale::kNaturalLog ? std::log(distance)
         : scale == Scale::kLog10    ? std::log10(distance)
                                     : 20.0 * std::log10(distance);
}

double Axis::level(double x) const noexcept {
  switch (scale) {
    case Scale::kLinear:
      return origin + x;
    case Scale::kNaturalLog:
      return origin + std::exp(x);
    case Scale::kLog10:
      return origin + std::pow(10.0, x);
    case Scale::kDecibel:
      return origin + std::pow(10.0, x / 20.0);
  }
  return std::numeric_limits<double>::quiet_NaN();
}

double Axis::gradient(double level) const noexcept {
  if (scale == Scale::kLinear) {
    return 1.0;
  }
  const double distance = level - origin;
  return distance <= 0.0 ? std::numeric_limits<double>::infinity()
                         : units_a_logarithm(scale) / distance;
}

std::string Axis::x_unit() const {
  const auto of = [this](const char* logarithm) {
    return unit.empty() ? std::string(logarithm) : std::string(logarithm) + "(" + unit + ")";
  };
  switch (scale) {
    case Scale::kLog10:
      return of("log10");
    case Scale::kNaturalLog:
      return of("ln");
    case Scale::kDecibel:
      return unit.empty() ? "dB" : "dB re 1 " + unit;
    default:
      return unit;
  }
}

}  // namespace haptrial::psychometric
