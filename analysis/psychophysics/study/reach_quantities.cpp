#include "analysis/psychophysics/study/reach_quantities.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "analysis/psychophysics/fit/series.h"
#include "analysis/statistics/base/descriptive.h"

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
    case ReachQuantity::kThroughput:
      return {"throughput",      "throughput", "bit/s",
              ReachKind::kPlain, nullptr,      ValueRange::kPositive};
    case ReachQuantity::kError:
      break;
  }
  return {"error", "perpendicular error", "m", ReachKind::kPlain,
          [](Result result, Reach r) { return result.error(r); }};
}

/// Whether each reach belongs to the plan's cycles of its block.
std::vector<bool> taken(const ReachingResult& result) {
  std::map<std::size_t, std::size_t> last;  // cycle of a block
  const auto cycle_of = [&](std::size_t i) { return result.reaches[i].place / result.plan.cycle; };
  for (std::size_t i = 0; i < result.reaches.size(); ++i) {
    std::size_t& cycle = last[result.block_of[i]];
    cycle = std::max(cycle, cycle_of(i));
  }
  std::vector<bool> all;
  for (std::size_t i = 0; i < result.reaches.size(); ++i) {
    const std::size_t wanted =
        result.plan.cycles == ReachCycles::kFirst ? 0 : last[result.block_of[i]];
    all.push_back(result.plan.cycles == ReachCycles::kAll || cycle_of(i) == wanted);
  }
  return all;
}

using Condition = std::pair<std::string, std::vector<std::string>>;  // a participant's
using Reaches = std::map<Condition, std::vector<const StudyReach*>>;

/// The reaches that count for a quantity, of each participant under each condition.
Reaches reaches_of(const TrialsData& data, const ReachingResult& reaching, const TrialsPlan& plan,
                   const std::vector<bool>& counts, ReachKind kind) {
  Reaches all;
  for (std::size_t i = 0; i < reaching.reaches.size(); ++i) {
    const StudyReach& reach = reaching.reaches[i];
    if (counts[i] && reach.kind == kind) {
      const StudyTrial& trial = data.trials[reach.trial];
      all[{data.session_of(trial).participant, factors_of(data, trial, plan)}].push_back(&reach);
    }
  }
  return all;
}

std::optional<double> mean_of(const Measure& measure, const ReachingResult& reaching,
                              const std::vector<const StudyReach*>& reaches) {
  double sum = 0.0, count = 0.0;
  for (const StudyReach* reach : reaches) {
    if (const auto value = measure.of(reaching, *reach)) {
      sum += *value;
      count += 1.0;
    }
  }
  return count > 0.0 ? std::optional(sum / count) : std::nullopt;
}

/// Bits per second of reaches over one distance to targets of one size.
std::optional<double> throughput_of_size(const std::vector<const StudyReach*>& reaches) {
  constexpr double kWidth = 4.133;  // standard deviations that hold 96 % of the ends
  std::vector<double> extents;
  double way = 0.0, time = 0.0;
  for (const StudyReach* reach : reaches) {
    const ReachMetrics& m = reach->metrics;
    if (m.endpoint_extent && m.movement_time) {
      extents.push_back(*m.endpoint_extent);
      way += (reach->way.target - reach->way.start).norm() + *m.endpoint_extent;
      time += *m.movement_time;
    }
  }
  const auto spread = moments(extents);
  if (!spread || extents.size() < 3 || !(spread->variance() > 0.0) || !(time > 0.0)) {
    return std::nullopt;
  }
  const auto n = static_cast<double>(extents.size());
  const double width = kWidth * std::sqrt(spread->variance());
  return std::log2(way / n / width + 1.0) / (time / n);
}

using Size = std::pair<long, long>;  // distance and radius of the target, in tenths of a mm

/// Throughput by combination of distance and size.
std::map<Size, double> throughputs(const std::vector<const StudyReach*>& reaches) {
  std::map<Size, std::vector<const StudyReach*>> sizes;
  const auto tenths = [](double length) { return std::lround(1e4 * length); };
  for (const StudyReach* reach : reaches) {
    sizes[{tenths((reach->way.target - reach->way.start).norm()), tenths(reach->way.target_radius)}]
        .push_back(reach);
  }
  std::map<Size, double> found;
  for (const auto& [size, of] : sizes) {
    if (const auto bits = throughput_of_size(of)) {
      found[size] = *bits;
    }
  }
  return found;
}

/// The mean of each participant under each condition, over the combinations that all conditions of
/// the participant have: means over different ones would compare these.
std::vector<QuantityValue> throughput_values(const Reaches& reaches,
                                             std::vector<std::string>& missing) {
  std::map<std::string, std::vector<std::pair<std::vector<std::string>, std::map<Size, double>>>>
      people;
  for (const auto& [of, each] : reaches) {
    people[of.first].emplace_back(of.second, throughputs(each));
  }
  std::vector<QuantityValue> values;
  for (const auto& [participant, conditions] : people) {
    std::map<Size, std::size_t> counts;
    for (const auto& [levels, found] : conditions) {
      for (const auto& [size, bits] : found) {
        ++counts[size];
      }
    }
    const auto all = static_cast<std::size_t>(std::ranges::count_if(
        counts, [&](const auto& each) { return each.second == conditions.size(); }));
    if (all < counts.size()) {
      missing.push_back(fmt::format(
          "throughput of {}: over {} of {} combinations of distance and size, as the others have "
          "fewer than three reaches with an end under some condition",
          participant, all, counts.size()));
    }
    for (const auto& [levels, found] : conditions) {
      double sum = 0.0;
      for (const auto& [size, bits] : found) {
        sum += counts[size] == conditions.size() ? bits : 0.0;
      }
      if (all > 0) {
        values.push_back({participant, levels, sum / static_cast<double>(all)});
      }
    }
  }
  return values;
}

/// The mean of each participant under each condition over the reaches that have a value.
std::vector<QuantityValue> mean_values(const Measure& measure, const ReachingResult& reaching,
                                       const Reaches& reaches, std::vector<std::string>& missing) {
  std::vector<QuantityValue> values;
  std::map<std::vector<std::string>, std::pair<std::size_t, std::size_t>> without;  // of all
  for (const auto& [of, each] : reaches) {
    auto& [none, all] = without[of.second];
    all += each.size();
    none += static_cast<std::size_t>(std::ranges::count_if(
        each, [&](const StudyReach* reach) { return !measure.of(reaching, *reach); }));
    if (const auto value = mean_of(measure, reaching, each)) {
      values.push_back({of.first, of.second, *value});
    }
  }
  for (const auto& [levels, counts] : without) {
    if (counts.first > 0) {
      missing.push_back(fmt::format("{}{}{}: {} of {} reaches have none", measure.title,
                                    levels.empty() ? "" : ", ", fmt::join(levels, ", "),
                                    counts.first, counts.second));
    }
  }
  return values;
}

/// Without conditions the error, which is the usual quantity, has its curves alone.
bool is_only_curves(const TrialsPlan& plan, const ReachingPlan& reaching) {
  return plan.by.empty() && reaching.quantities == std::vector{ReachQuantity::kError};
}

}  // namespace

std::vector<Quantity> reach_quantities(const TrialsData& data, const ReachingResult& reaching,
                                       const TrialsPlan& plan) {
  std::vector<Quantity> all;
  if (is_only_curves(plan, reaching.plan)) {
    return all;
  }
  const std::vector<bool> counts = taken(reaching);
  for (const ReachQuantity each : reaching.plan.quantities) {
    const Measure measure = measure_of(each);
    const Reaches reaches = reaches_of(data, reaching, plan, counts, measure.kind);
    std::vector<std::string> missing;
    const std::vector<QuantityValue> values =
        each == ReachQuantity::kThroughput ? throughput_values(reaches, missing)
                                           : mean_values(measure, reaching, reaches, missing);
    all.push_back(quantity(measure.name, measure.title, measure.unit, values, plan, measure.range));
    all.back().missing = std::move(missing);
  }
  return all;
}

}  // namespace haptrial::analysis::trials
