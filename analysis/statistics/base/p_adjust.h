#pragma once

#include <span>
#include <vector>

#include "analysis/statistics/base/defined.h"

namespace haptrial::analysis {

/// p values of hypotheses tested together, adjusted, in the order given: a hypothesis is rejected
/// at level a where its adjusted p is at most a. Holm's step-down procedure: the chance of any
/// false rejection stays below a. Never weaker than Bonferroni's.
/// @throws std::invalid_argument when a value is outside [0, 1] or not a number.
/// Source: Holm 1979, Scandinavian Journal of Statistics 6.
std::vector<double> holm_adjusted(std::span<const double> p_values);

/// Holm's p over the tests that are defined, each at its own place.
template <class Test>
std::vector<Defined<double>> holm_over(const std::vector<Defined<Test>>& tests) {
  std::vector<double> p_values;
  for (const auto& test : tests) {
    if (test) {
      p_values.push_back(test->p);
    }
  }
  const std::vector<double> adjusted = holm_adjusted(p_values);
  auto next = adjusted.begin();
  std::vector<Defined<double>> result;
  for (const auto& test : tests) {
    result.push_back(test ? Defined<double>(*next++) : Undefined{test.because()});
  }
  return result;
}

}  // namespace haptrial::analysis
