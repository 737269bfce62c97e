#include "analysis/statistics/variance/levene.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/statistics/base/descriptive.h"

namespace haptrial::analysis {
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

}  // namespace haptrial::analysis
