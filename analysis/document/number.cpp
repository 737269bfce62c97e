#include "analysis/document/number.h"

#include <fmt/format.h>

#include <cmath>

namespace haptrial::analysis {

std::string number(double value) {
  const double size = std::abs(value);
  return size >= 1e3 && size < 1e7 ? fmt::format("{:.0f}", value) : fmt::format("{:#.4g}", value);
}

std::string number_within(double value, double low, double high) {
  constexpr double kRounding = 1e-12;
  const double extent = std::abs(high - low);
  const bool rounding = std::isfinite(extent) && std::abs(value) < kRounding * extent;
  return rounding ? "0" : number(value);
}

std::string number_with_interval(double value, double low, double high) {
  if (std::isnan(value)) {
    return "–";
  }
  const auto end = [](double x) { return std::isinf(x) ? std::string("open") : number(x); };
  const bool interval = !std::isnan(low) && !std::isnan(high);
  return interval ? fmt::format("{} [{}, {}]", number_within(value, low, high), end(low), end(high))
                  : number(value);
}

}  // namespace haptrial::analysis
