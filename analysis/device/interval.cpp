#include "analysis/device/interval.h"

#include <cmath>

#include "analysis/statistics/base/distributions.h"

namespace haptrial::analysis {
namespace {

constexpr double kUpper = 0.975;

double error_of(const Interval& part) {
  return 0.5 * (part.high - part.low) / t_quantile(kUpper, part.df);
}

}  // namespace

Interval interval_of(double value, double error, double df) {
  const double half = t_quantile(kUpper, df) * error;
  return {value, value - half, value + half, df};
}

Interval mean_of(const std::vector<Interval>& parts) {
  double sum = 0.0, variance = 0.0, fourth = 0.0;
  for (const Interval& part : parts) {
    const double square = std::pow(error_of(part), 2);
    sum += part.value;
    variance += square;
    fourth += square * square / part.df;
  }
  const double n = static_cast<double>(parts.size());
  const double df = fourth > 0.0 ? variance * variance / fourth : parts.front().df;
  return interval_of(sum / n, std::sqrt(variance) / n, df);
}

}  // namespace haptrial::analysis
