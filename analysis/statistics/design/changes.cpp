#include "analysis/statistics/design/changes.h"

#include <map>
#include <utility>

namespace haptrial::analysis {
namespace {

/// A participant under a combination of levels.
using Cell = std::pair<std::string, std::vector<std::string>>;

std::map<Cell, double> means_of(std::span<const Observation> observations) {
  std::map<Cell, std::pair<double, std::size_t>> sums;
  for (const Observation& each : observations) {
    auto& [sum, count] = sums[{each.subject, each.levels}];
    sum += each.value;
    ++count;
  }
  std::map<Cell, double> means;
  for (const auto& [cell, total] : sums) {
    means[cell] = total.first / static_cast<double>(total.second);
  }
  return means;
}

}  // namespace

std::vector<Observation> changes_from(std::span<const Observation> observations, std::size_t factor,
                                      const std::string& baseline) {
  const std::map<Cell, double> means = means_of(observations);
  std::vector<Observation> changes;
  for (const auto& [cell, mean] : means) {
    Cell before = cell;
    before.second.at(factor) = baseline;
    const auto at = means.find(before);
    if (cell != before && at != means.end()) {
      changes.push_back({cell.first, cell.second, mean - at->second});
    }
  }
  return changes;
}

}  // namespace haptrial::analysis
