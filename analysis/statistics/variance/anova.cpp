#include "analysis/statistics/variance/anova.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/statistics/base/descriptive.h"
#include "analysis/statistics/base/distributions.h"

namespace haptrial::analysis {
namespace {

using Table = std::vector<std::vector<double>>;

// Moments of all values from those of the groups: deviations of group means from the grand mean.
double between_squares(const std::vector<Moments>& groups) {
  double total = 0.0;
  double offset = 0.0;  // grand mean - mean of the first group
  for (const auto& group : groups) {
    total += static_cast<double>(group.count);
    offset += static_cast<double>(group.count) * mean_difference(group, groups.front());
  }
  offset /= total;
  double squares = 0.0;
  for (const auto& group : groups) {
    const double deviation = mean_difference(group, groups.front()) - offset;
    squares += static_cast<double>(group.count) * deviation * deviation;
  }
  return squares;
}

Defined<std::vector<Moments>> group_moments(const Table& groups) {
  std::vector<Moments> result;
  for (const auto& group : groups) {
    const auto m = moments(group);
    if (!m) {
      return Undefined{group.empty() ? "a group is empty" : m.because()};
    }
    result.push_back(*m);
  }
  return result;
}

}  // namespace

Defined<Anova> one_way_anova(const Table& groups) {
  if (groups.size() < 2) {
    return Undefined{"there are fewer than two groups"};
  }
  const auto each = group_moments(groups);
  if (!each) {
    return Undefined{each.because()};
  }
  Anova result;
  double total = 0.0;
  for (const auto& group : *each) {
    total += static_cast<double>(group.count);
    result.squares_within += group.squares;
  }
  result.df_between = static_cast<double>(groups.size() - 1);
  result.df_within = total - static_cast<double>(groups.size());
  if (result.df_within < 1.0) {
    return Undefined{"every group has a single value"};
  }
  if (result.squares_within == 0.0) {
    return Undefined{"the values do not vary within any group"};
  }
  result.squares_between = between_squares(*each);
  result.f =
      (result.squares_between / result.df_between) / (result.squares_within / result.df_within);
  if (!std::isfinite(result.f)) {
    return Undefined{kBeyondDouble};
  }
  result.p = f_upper_tail(result.f, result.df_between, result.df_within);
  result.eta_squared = result.squares_between / (result.squares_between + result.squares_within);
  return result;
}

namespace {

// The first value is subtracted before, so that a large constant costs no digits.
std::vector<double> distances(const std::vector<double>& group, Centre centre) {
  std::vector<double> result;
  for (const double value : group) {
    result.push_back(value - group.front());
  }
  const double middle =
      centre == Centre::kMedian ? *quantile(result, 0.5) : moments(result)->mean();
  for (double& value : result) {
    value = std::abs(value - middle);
  }
  return result;
}

}  // namespace

Defined<Anova> levene(const std::vector<std::vector<double>>& groups, Centre centre) {
  std::vector<std::vector<double>> spread;
  double largest = 0.0;
  double squares = 0.0;  // of the distances, within groups
  std::size_t count = 0;
  for (const auto& group : groups) {
    if (const auto m = moments(group); !m) {
      return Undefined{group.empty() ? "a group is empty" : m.because()};
    }
    spread.push_back(distances(group, centre));
    largest = std::max(largest, *std::max_element(spread.back().begin(), spread.back().end()));
    squares += moments(spread.back())->squares;
    count += group.size();
  }
  const double unit = 8.0 * std::numeric_limits<double>::epsilon() * largest;
  if (groups.size() > 1 && count > groups.size() &&
      squares <= static_cast<double>(count) * unit * unit) {
    return Undefined{"all values of a group lie equally far from its centre"};
  }
  return one_way_anova(spread);
}

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
