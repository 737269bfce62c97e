#include "analysis/trials/psychometric/quantity.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace haptrial::analysis::trials {

Quantity quantity(std::string name, std::string title, std::string unit,
                  const std::vector<QuantityValue>& values, const TrialsPlan& plan) {
  Quantity result;
  result.name = std::move(name);
  result.title = std::move(title);
  result.unit = std::move(unit);
  const bool one = plan.by.empty();
  std::vector<Observation> observations;
  for (const QuantityValue& each : values) {
    if (std::isfinite(each.value)) {
      observations.push_back(
          {each.participant, one ? std::vector<std::string>{"all"} : each.levels, each.value});
    }
  }
  if (observations.empty()) {
    return result;
  }
  result.table = design_table(observations, one ? std::vector<std::string>{"condition"} : plan.by);
  for (std::size_t cell = 0; cell < result.table.cells.size(); ++cell) {
    std::vector<double> means;
    for (const auto& row : result.table.means) {
      if (row[cell]) {
        means.push_back(*row[cell]);
      }
    }
    result.means.push_back(mean_interval(means));
  }
  result.compared = result.table.cells.size() > 1;
  if (result.compared) {
    Resampling resampling;
    resampling.seed = plan.seed;
    resampling.stream = "trials " + result.name;
    resampling.count = plan.permutations;
    result.tests = design_tests(result.table, plan.plan, resampling);
  }
  return result;
}

void keep_within(Quantity& quantity, double low, double high) {
  for (Defined<MeanInterval>& mean : quantity.means) {
    if (mean) {
      MeanInterval cut = *mean;
      cut.low = std::max(cut.low, low);
      cut.high = std::min(cut.high, high);
      mean = cut;
    }
  }
}

}  // namespace haptrial::analysis::trials
