#include "analysis/levene.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/descriptive.h"

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
  double count = 0.0;
  for (const auto& group : groups) {
    const auto m = moments(group);
    if (!m) {
      return Undefined{group.empty() ? "a group is empty" : m.because()};
    }
    spread.push_back(distances(group, centre));
    largest = std::max(largest, *std::max_element(spread.back().begin(), spread.back().end()));
    count += static_cast<double>(group.size());
  }
  const auto anova = one_way_anova(spread);
  const double unit = 8.0 * std::numeric_limits<double>::epsilon() * largest;
  if (anova && anova->squares_within <= count * unit * unit) {
    return Undefined{"all values of a group lie equally far from its centre"};
  }
  return anova;
}

}  // namespace haptrial::analysis
