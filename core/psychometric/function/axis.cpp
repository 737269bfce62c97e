#include "core/psychometric/function/axis.h"

#include <cmath>
#include <limits>
#include <numbers>

namespace haptrial::psychometric {
namespace {

double units_a_decade(Scale scale) noexcept { return scale == Scale::kDecibel ? 20.0 : 1.0; }

}  // namespace

double Axis::at(double level) const noexcept {
  const double distance = level - origin;
  if (scale == Scale::kLinear) {
    return distance;
  }
  return distance <= 0.0 ? -std::numeric_limits<double>::infinity()
                         : units_a_decade(scale) * std::log10(distance);
}

double Axis::level(double x) const noexcept {
  return origin + (scale == Scale::kLinear ? x : std::pow(10.0, x / units_a_decade(scale)));
}

double Axis::gradient(double level) const noexcept {
  if (scale == Scale::kLinear) {
    return 1.0;
  }
  const double distance = level - origin;
  return distance <= 0.0 ? std::numeric_limits<double>::infinity()
                         : units_a_decade(scale) / (std::numbers::ln10 * distance);
}

}  // namespace haptrial::psychometric
