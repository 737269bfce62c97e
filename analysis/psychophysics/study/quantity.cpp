#include "analysis/psychophysics/study/quantity.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "analysis/statistics/design/compared_sides.h"
#include "core/base/error.h"

namespace haptrial::analysis::trials {

TrialsPlan without_directions(TrialsPlan plan) {
  for (PlannedTest& test : plan.plan.tests) {
    test.tail = Tail::kTwoSided;
  }
  return plan;
}

MeanInterval within_range(MeanInterval mean, ValueRange range) {
  const double half = mean.high - mean.mean;
  if (range == ValueRange::kPositive && mean.mean > 0.0) {
    const double factor = std::exp(half / mean.mean);
    mean.low = mean.mean / factor;
    mean.high = mean.mean * factor;
  }
  if (range == ValueRange::kShare && mean.mean > 0.0 && mean.mean < 1.0) {
    const double odds = mean.mean / (1.0 - mean.mean);
    const double factor = std::exp(half / (mean.mean * (1.0 - mean.mean)));
    mean.low = odds / (odds + factor);
    mean.high = odds / (odds + 1.0 / factor);
  }
  return mean;
}

std::optional<double> mean_of(const Quantity& q, std::size_t cell) {
  if (q.means[cell]) {
    return q.means[cell]->mean;
  }
  std::vector<double> values;
  for (const auto& row : q.table.means) {
    if (row[cell]) {
      values.push_back(*row[cell]);
    }
  }
  const auto all = moments(values);
  return q.open.empty() && all ? std::optional(all->mean()) : std::nullopt;
}

namespace {

Undefined left_out(const std::vector<std::string>& open, std::size_t others) {
  return {fmt::format("{} of {} values have an interval with an open side ({})", open.size(),
                      open.size() + others, fmt::join(open, ", "))};
}

}  // namespace

Quantity quantity(std::string name, std::string title, std::string unit,
                  const std::vector<QuantityValue>& values, const TrialsPlan& plan,
                  ValueRange range) {
  Quantity result;
  result.name = std::move(name);
  result.title = std::move(title);
  result.unit = std::move(unit);
  const bool one = plan.by.empty();
  std::vector<Observation> observations;
  std::map<std::string, std::vector<std::string>> open;  // participants by condition
  for (const QuantityValue& each : values) {
    if (each.open) {
      open[one ? "all" : fmt::format("{}", fmt::join(each.levels, ", "))].push_back(
          each.participant);
      if (std::ranges::find(result.open, each.participant) == result.open.end()) {
        result.open.push_back(each.participant);
      }
    } else if (std::isfinite(each.value)) {
      observations.push_back(
          {each.participant, one ? std::vector<std::string>{"all"} : each.levels, each.value});
    }
  }
  if (!plan.baseline.empty()) {
    const auto session =
        static_cast<std::size_t>(std::ranges::find(plan.by, kSession) - plan.by.begin());
    observations = changes_from(observations, session, plan.baseline);
    result.title = "change of " + result.title;
    range = ValueRange::kAny;
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
    const auto beyond = open.find(result.table.names[cell]);
    Defined<MeanInterval> mean = mean_interval(means);
    if (beyond != open.end()) {
      mean = left_out(beyond->second, means.size());
    } else if (mean) {
      mean = within_range(*mean, range);
    }
    result.means.push_back(std::move(mean));
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

Quantity* compared_quantity(std::vector<Quantity>& all, const std::string& name,
                            std::string_view key) {
  std::vector<std::string> names;
  Quantity* first = nullptr;
  for (Quantity& each : all) {
    if (!each.compared) {
      continue;
    }
    if (each.name == name || (name.empty() && each.headline)) {
      return &each;
    }
    first = first == nullptr ? &each : first;
    names.push_back(each.name);
  }
  if (!name.empty() && !names.empty()) {
    throw InputError(fmt::format("{} is \"{}\"; allowed: {}", key, name, fmt::join(names, ", ")));
  }
  return first;
}

void keep_equivalence(std::vector<Quantity>& all, const TestsBeside& beside) {
  if (!(beside.equivalence > 0.0)) {
    return;
  }
  const Quantity* kept = compared_quantity(all, beside.equivalence_of, "analysis.equivalence_of");
  for (Quantity& each : all) {
    for (SideTest& test : each.tests.planned.tests) {
      if (&each != kept) {
        test.beside.equivalence = 0.0;
        test.equivalence = Undefined{kNotAskedFor};
        test.equivalence_holm = Undefined{kNotAskedFor};
      }
    }
  }
}

void separate_secondary(std::vector<Quantity>& all, const TrialsPlan& plan) {
  const auto& rule = plan.plan.sequential;
  const bool by_rule = plan.tests_of.empty() && rule;
  const Quantity* primary =
      compared_quantity(all, by_rule ? rule->of : plan.tests_of,
                        by_rule ? "analysis.sequential.of" : "analysis.tests_of");
  const auto is_secondary = [&](const Quantity& q) { return q.compared && &q != primary; };
  TestFamily together{"secondary", {}};
  for (Quantity& each : all) {
    each.tests.ends_by_rule = rule.has_value();
    if (is_secondary(each)) {
      const auto& own = each.tests.planned.tests;
      together.tests.insert(together.tests.end(), own.begin(), own.end());
    }
  }
  adjust(together);
  auto next = together.tests.begin();
  for (Quantity& each : all) {
    if (is_secondary(each)) {
      each.tests.planned.name = together.name;
      for (SideTest& test : each.tests.planned.tests) {
        test = *next++;
      }
    }
  }
}

}  // namespace haptrial::analysis::trials
