#include "analysis/device/cogging.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace haptrial::analysis {
namespace {

constexpr double kCell = 1e-4;         // [m]
constexpr double kLeastPeriod = 4e-4;  // [m]

struct Bins {
  double first;
  std::vector<double> sum, count;
};

Bins bins_of(const std::vector<double>& x, const std::vector<double>& value, double low,
             double high) {
  Bins bins{low, {}, {}};
  const auto count = static_cast<std::size_t>((high - low) / kCell) + 1;
  bins.sum.resize(count);
  bins.count.resize(count);
  for (std::size_t i = 0; i < x.size(); ++i) {
    const auto at = static_cast<std::size_t>((x[i] - low) / kCell);
    bins.sum[at] += value[i];
    bins.count[at] += 1.0;
  }
  return bins;
}

}  // namespace

SineOverWay strongest_sine(const std::vector<double>& x, const std::vector<double>& left) {
  const auto [low, high] = std::minmax_element(x.begin(), x.end());
  const double span = *high - *low;
  const Bins bins = bins_of(x, left, *low, *high);
  double best = 0.0;
  SineOverWay found;
  for (double f = 1.5 / span; f < 1.0 / kLeastPeriod; f += 0.2 / span) {
    double cosine = 0.0, sine = 0.0, count = 0.0;
    for (std::size_t i = 0; i < bins.sum.size(); ++i) {
      const double angle =
          2.0 * std::numbers::pi * f * (bins.first + (static_cast<double>(i) + 0.5) * kCell);
      cosine += bins.sum[i] * std::cos(angle);
      sine += bins.sum[i] * std::sin(angle);
      count += bins.count[i];
    }
    const double power = cosine * cosine + sine * sine;
    if (power > best) {
      best = power;
      found = {2.0 * cosine / count, 2.0 * sine / count, f};
    }
  }
  return found;
}

}  // namespace haptrial::analysis
