#include "analysis/statistics/relation/coefficient.h"

#include <algorithm>
#include <cmath>

#include "analysis/statistics/base/distributions.h"

namespace haptrial::analysis {

Coefficient coefficient(double estimate, double error, double df, double level) {
  const double t = estimate / error;
  const double half = t_quantile(0.5 * (1.0 + level), df) * error;
  const double p = std::min(1.0, 2.0 * t_upper_tail(std::abs(t), df));
  return {estimate, error, df, t, p, estimate - half, estimate + half};
}

}  // namespace haptrial::analysis
