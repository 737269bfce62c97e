#include "analysis/psychometric/fit/knots.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace haptrial::analysis {

Knots::Knots(const psychometric::QuestDimension& parameter) {
  std::vector<std::pair<double, double>> knots;
  for (std::size_t i = 0; i < parameter.values.size(); ++i) {
    knots.emplace_back(parameter.values[i], parameter.prior.empty() ? 1.0 : parameter.prior[i]);
  }
  std::sort(knots.begin(), knots.end());
  for (const auto& [value, weight] : knots) {
    values_.push_back(value);
    weights_.push_back(weight);
  }
}

double Knots::between(const std::vector<double>& of, double place) noexcept {
  if (of.size() == 1) {
    return of.front();
  }
  const auto left = std::min(static_cast<std::size_t>(std::max(0.0, place)), of.size() - 2);
  const double share = place - static_cast<double>(left);
  return of[left] + share * (of[left + 1] - of[left]);
}

}  // namespace haptrial::analysis
