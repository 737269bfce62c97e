#include "analysis/statistics/base/ranks.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace haptrial::analysis {

bool Ranks::all_tied() const {
  const auto n = static_cast<double>(ranks.size());
  return ties == n * n * n - n;
}

Defined<Ranks> midranks(std::span<const double> values) {
  if (values.empty()) {
    return Undefined{"there are no values"};
  }
  if (!std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); })) {
    return Undefined{"a value is not a finite number"};
  }
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t i, std::size_t j) { return values[i] < values[j]; });
  Ranks result{std::vector<double>(values.size())};
  for (std::size_t first = 0; first < order.size();) {
    std::size_t end = first + 1;
    while (end < order.size() && values[order[end]] == values[order[first]]) {
      ++end;
    }
    for (std::size_t i = first; i < end; ++i) {
      result.ranks[order[i]] = 0.5 * static_cast<double>(first + 1 + end);
    }
    const auto tied = static_cast<double>(end - first);
    result.ties += tied * tied * tied - tied;
    first = end;
  }
  return result;
}

}  // namespace haptrial::analysis
