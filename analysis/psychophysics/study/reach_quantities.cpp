#include "analysis/psychophysics/study/reach_quantities.h"

#include <map>
#include <optional>
#include <string>
#include <utility>

#include "analysis/psychophysics/fit/series.h"

namespace haptrial::analysis::trials {
namespace {

/// Name of a quantity, and its value in a reach.
struct Measure {
  const char* name;
  const char* title;
  const char* unit;
  ReachKind kind;
  std::optional<double> (*of)(const ReachingResult& result, const StudyReach& reach);
  ValueRange range{ValueRange::kAny};
};

Measure measure_of(ReachQuantity quantity) {
  using Result = const ReachingResult&;
  using Reach = const StudyReach&;
  switch (quantity) {
    case ReachQuantity::kMovementTime:
      return {"movement_time",
              "movement time",
              "s",
              ReachKind::kPlain,
              [](Result, Reach r) { return r.metrics.movement_time; },
              ValueRange::kPositive};
    case ReachQuantity::kPeakSpeed:
      return {"peak_speed",
              "peak speed",
              "m/s",
              ReachKind::kPlain,
              [](Result, Reach r) { return r.metrics.peak_speed; },
              ValueRange::kPositive};
    case ReachQuantity::kDirection:
      return {"direction", "direction error at 150 ms", "rad", ReachKind::kPlain,
              [](Result, Reach r) { return r.turned(r.metrics.direction_error); }};
    case ReachQuantity::kArea:
      return {"area", "signed area", "m²", ReachKind::kPlain,
              [](Result, Reach r) { return r.turned(r.metrics.signed_area); }};
    case ReachQuantity::kForceCompensation:
      return {"force_compensation", "force compensation", "", ReachKind::kClamp,
              [](Result, Reach r) {
                return r.compensation ? std::optional(r.compensation->slope) : std::nullopt;
              }};
    case ReachQuantity::kError:
      break;
  }
  return {"error", "perpendicular error", "m", ReachKind::kPlain,
          [](Result result, Reach r) { return result.error(r); }};
}

/// Whether each reach belongs to the plan's cycles of its block.
std::vector<bool> taken(const ReachingResult& result) {
  using Place = std::pair<std::size_t, std::string>;  // a participant's block
  std::map<Place, std::size_t> trials, seen;
  for (std::size_t i = 0; i < result.reaches.size(); ++i) {
    ++trials[{result.persons[i], result.reaches[i].block}];
  }
  std::vector<bool> all;
  for (std::size_t i = 0; i < result.reaches.size(); ++i) {
    const Place of{result.persons[i], result.reaches[i].block};
    const std::size_t cycle = seen[of]++ / result.plan.cycle;
    const std::size_t last = (trials[of] - 1) / result.plan.cycle;
    all.push_back(result.plan.cycles == ReachCycles::kAll ||
                  cycle == (result.plan.cycles == ReachCycles::kFirst ? 0 : last));
  }
  return all;
}

}  // namespace

std::vector<Quantity> reach_quantities(const TrialsData& data, const ReachingResult& reaching,
                                       const TrialsPlan& plan) {
  std::vector<Quantity> all;
  if (plan.by.empty()) {
    return all;
  }
  const std::vector<bool> counts = taken(reaching);
  for (const ReachQuantity each : reaching.plan.quantities) {
    const Measure measure = measure_of(each);
    std::map<std::pair<std::string, std::vector<std::string>>, std::pair<double, double>> sums;
    for (std::size_t i = 0; i < reaching.reaches.size(); ++i) {
      const StudyReach& reach = reaching.reaches[i];
      const auto value = measure.of(reaching, reach);
      if (counts[i] && reach.kind == measure.kind && value) {
        const StudyTrial& trial = data.trials[reach.trial];
        auto& [sum, count] =
            sums[{data.session_of(trial).participant, factors_of(data, trial, plan)}];
        sum += *value;
        count += 1.0;
      }
    }
    std::vector<QuantityValue> values;
    for (const auto& [of, sum] : sums) {
      values.push_back({of.first, of.second, sum.first / sum.second});
    }
    all.push_back(quantity(measure.name, measure.title, measure.unit, values, plan, measure.range));
  }
  return all;
}

}  // namespace haptrial::analysis::trials
