#include "analysis/statistics/variance/anova.h"

#include <cmath>

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

}  // namespace haptrial::analysis
