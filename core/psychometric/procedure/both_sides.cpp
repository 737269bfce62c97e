#include "core/psychometric/procedure/both_sides.h"

#include <cmath>
#include <numeric>

namespace haptrial::psychometric {
namespace {

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double squares_about_mean(const std::vector<double>& values) {
  const double middle = mean(values);
  double sum = 0.0;
  for (const double value : values) {
    sum += (value - middle) * (value - middle);
  }
  return sum;
}

Estimate mean_over(const std::vector<std::vector<double>>& sides) {
  double middle = 0.0, squares = 0.0, freedom = 0.0, inverse = 0.0;
  const auto n = static_cast<double>(sides.size());
  for (const std::vector<double>& side : sides) {
    const auto count = static_cast<double>(side.size());
    middle += mean(side) / n;
    squares += squares_about_mean(side);
    freedom += count - 1.0;
    inverse += 1.0 / count;
  }
  Estimate estimate{"", middle, {}};
  if (freedom > 0.0 && squares > 0.0) {  // values that do not vary tell no deviation
    estimate.deviation = std::sqrt(squares / freedom * inverse) / n;
    estimate.freedom = freedom;
  }
  return estimate;
}

}  // namespace

bool sides_count_alike(const std::vector<double>& below, const std::vector<double>& above) {
  return below.size() >= 2 && above.size() >= 2;
}

Estimate mean_of_sides(const std::vector<double>& below, const std::vector<double>& above) {
  if (sides_count_alike(below, above)) {
    return mean_over({below, above});
  }
  std::vector<double> all = below;
  all.insert(all.end(), above.begin(), above.end());
  return mean_over({all});
}

}  // namespace haptrial::psychometric
