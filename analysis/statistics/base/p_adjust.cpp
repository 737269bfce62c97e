#include "analysis/statistics/base/p_adjust.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>

namespace haptrial::analysis {
namespace {

void check(std::span<const double> p_values, const char* function) {
  if (!std::all_of(p_values.begin(), p_values.end(),
                   [](double p) { return p >= 0.0 && p <= 1.0; })) {
    throw std::invalid_argument(std::string(function) + ": a p value lies outside [0, 1]");
  }
}

// Places of the values, smallest value first.
std::vector<std::size_t> ascending(std::span<const double> p_values) {
  std::vector<std::size_t> order(p_values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t i, std::size_t j) { return p_values[i] < p_values[j]; });
  return order;
}

}  // namespace

std::vector<double> holm_adjusted(std::span<const double> p_values) {
  check(p_values, "holm_adjusted");
  const auto order = ascending(p_values);
  std::vector<double> adjusted(p_values.size());
  double running = 0.0;
  for (std::size_t rank = 0; rank < order.size(); ++rank) {
    const auto hypotheses_left = static_cast<double>(order.size() - rank);
    running = std::max(running, std::min(1.0, hypotheses_left * p_values[order[rank]]));
    adjusted[order[rank]] = running;
  }
  return adjusted;
}

std::vector<double> bonferroni_adjusted(std::span<const double> p_values) {
  check(p_values, "bonferroni_adjusted");
  std::vector<double> adjusted;
  for (const double p : p_values) {
    adjusted.push_back(std::min(1.0, static_cast<double>(p_values.size()) * p));
  }
  return adjusted;
}

std::vector<double> benjamini_hochberg_adjusted(std::span<const double> p_values) {
  check(p_values, "benjamini_hochberg_adjusted");
  const auto order = ascending(p_values);
  std::vector<double> adjusted(p_values.size());
  double running = 1.0;
  for (std::size_t rank = order.size(); rank-- > 0;) {  // the largest p first
    const double share = static_cast<double>(order.size()) / static_cast<double>(rank + 1);
    running = std::min(running, share * p_values[order[rank]]);
    adjusted[order[rank]] = running;
  }
  return adjusted;
}

}  // namespace haptrial::analysis
