#include "analysis/statistics/base/p_adjust.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>

namespace haptrial::analysis {

std::vector<double> holm_adjusted(std::span<const double> p_values) {
  if (!std::ranges::all_of(p_values, [](double p) { return p >= 0.0 && p <= 1.0; })) {
    throw std::invalid_argument("holm_adjusted: a p value lies outside [0, 1]");
  }
  std::vector<std::size_t> order(p_values.size());  // places of the values, smallest value first
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t i, std::size_t j) { return p_values[i] < p_values[j]; });
  std::vector<double> adjusted(p_values.size());
  double running = 0.0;
  for (std::size_t rank = 0; rank < order.size(); ++rank) {
    const auto hypotheses_left = static_cast<double>(order.size() - rank);
    running = std::max(running, std::min(1.0, hypotheses_left * p_values[order[rank]]));
    adjusted[order[rank]] = running;
  }
  return adjusted;
}

}  // namespace haptrial::analysis
