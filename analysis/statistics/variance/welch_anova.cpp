#include "analysis/statistics/variance/welch_anova.h"

#include <cmath>

#include "analysis/statistics/base/descriptive.h"
#include "analysis/statistics/base/distributions.h"

namespace haptrial::analysis {

Defined<Anova> welch_anova(const std::vector<std::vector<double>>& groups) {
  if (groups.size() < 2) {
    return Undefined{"there are fewer than two groups"};
  }
  std::vector<Moments> each;
  for (const auto& group : groups) {
    const auto m = moments(group);
    if (!m) {
      return Undefined{group.empty() ? "a group is empty" : m.because()};
    }
    if (m->count < 2) {
      return Undefined{"a group has a single value"};
    }
    if (m->squares == 0.0) {
      return Undefined{"the values do not vary within a group"};
    }
    each.push_back(*m);
  }
  const auto weight = [](const Moments& m) { return static_cast<double>(m.count) / m.variance(); };
  double total = 0.0;
  double offset = 0.0;  // weighed mean - mean of the first group
  for (const Moments& m : each) {
    total += weight(m);
    offset += weight(m) * mean_difference(m, each.front());
  }
  offset /= total;
  double squares = 0.0;
  double spread = 0.0;
  for (const Moments& m : each) {
    const double deviation = mean_difference(m, each.front()) - offset;
    squares += weight(m) * deviation * deviation;
    const double rest = 1.0 - weight(m) / total;
    spread += rest * rest / static_cast<double>(m.count - 1);
  }
  const auto k = static_cast<double>(groups.size());
  const double share = spread / (k * k - 1.0);
  Anova result;
  result.df_between = k - 1.0;
  result.df_within = 1.0 / (3.0 * share);
  result.f = squares / (k - 1.0) / (1.0 + 2.0 * (k - 2.0) * share);
  if (!std::isfinite(result.f) || !std::isfinite(result.df_within)) {
    return Undefined{kBeyondDouble};
  }
  result.p = f_upper_tail(result.f, result.df_between, result.df_within);
  return result;
}

}  // namespace haptrial::analysis
