#include "analysis/power/power_result.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace haptrial::analysis {

void RunningMean::add(double value) {
  ++count;
  const double step = value - mean;
  mean += step / static_cast<double>(count);
  squares += step * (value - mean);
}

double RunningMean::deviation() const {
  return count > 1 ? std::sqrt(squares / static_cast<double>(count - 1)) : 0.0;
}

double RunningMean::error() const {
  return count > 1 ? deviation() / std::sqrt(static_cast<double>(count)) : 0.0;
}

TestCount CellCounts::of(const std::string& test) const {
  const auto at = tests.find(test);
  return at == tests.end() ? TestCount{} : at->second;
}

std::optional<std::size_t> PowerResult::participants() const {
  const auto at = std::ranges::find(keys, "design.participants", &PowerKey::name);
  return at == keys.end() ? std::nullopt : std::optional<std::size_t>(at - keys.begin());
}

Level level_in(const PowerCell& cell, const std::string& test, double alpha) {
  const TestCount count = cell.counts.of(test);
  if (count.made == 0) {
    return Level::kUnknown;
  }
  const CountBand band = binomial_band(count.made, alpha, kNullBand);
  return count.rejected > band.high  ? Level::kAbove
         : count.rejected < band.low ? Level::kBelow
                                     : Level::kKept;
}

Level level_of(const PowerResult& result, const std::string& test) {
  Level level = result.nulls.empty() ? Level::kUnknown : Level::kKept;
  for (const PowerCell& cell : result.nulls) {
    const Level here = level_in(cell, test, result.alpha);
    if (here == Level::kAbove || here == Level::kUnknown) {
      return here;
    }
    level = here == Level::kBelow ? here : level;
  }
  return level;
}

bool is_power(const PowerResult& result) {
  const Level level = level_of(result, result.watch);
  return level == Level::kKept || level == Level::kBelow;
}

std::string words_of(const PowerResult& result, const PowerCell& cell) {
  std::string words;
  for (std::size_t i = 0; i < result.keys.size(); ++i) {
    words += fmt::format("{}{} {}", i == 0 ? "" : ", ", result.keys[i].name, cell.levels[i]);
  }
  return words;
}

}  // namespace haptrial::analysis
