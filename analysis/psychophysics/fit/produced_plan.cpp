#include "analysis/psychophysics/fit/produced_plan.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/base/definition/schema.h"

namespace haptrial::analysis::trials {
namespace {

std::vector<std::string> names_of_measures(const std::vector<MeasureName>& measures) {
  std::vector<std::string> names;
  for (const MeasureName& each : measures) {
    names.push_back(each.name);
  }
  return names;
}

/// Takes words and unit of the measure that is named.
void take_measure(Table& table, const ProducedNames& names, ProducedPlan& plan) {
  const auto measure = std::ranges::find(names.measures, plan.measure, &MeasureName::name);
  if (measure != names.measures.end()) {
    plan.words = measure->words;
    plan.unit = measure->unit;
  } else if (names.measures.empty()) {
    table.reject("kind", "\"produced\" without a measure",
                 "another kind, or add [measures.NAME], which says what is measured");
  } else {
    table.reject("measure", fmt::format("\"{}\"", plan.measure),
                 fmt::format("one of: {}", fmt::join(names_of_measures(names.measures), ", ")));
  }
}

void check_target(Table& table, const ProducedNames& names, const ProducedPlan& plan) {
  if (!plan.target.empty() &&
      std::ranges::find(names.variables, plan.target) == names.variables.end()) {
    table.reject("target", fmt::format("\"{}\"", plan.target),
                 names.variables.empty()
                     ? std::string("none: the definition has no variable")
                     : fmt::format("one of: {}", fmt::join(names.variables, ", ")));
  }
}

}  // namespace

ProducedPlan read_produced_plan(Table& table, const ProducedNames& names) {
  using P = ProducedPlan;
  return Schema<P>()
      .derive([&](P& plan) {
        plan.measure = names.measures.empty() ? "" : names.measures.front().name;
      })
      .text("measure", &P::measure, "Measure whose values are compared")
      .otherwise("the first of [measures]")
      .text("target", &P::target,
            "Variable of the trial that the measure was to equal, in its unit; the report then has "
            "errors")
      .otherwise("none: there are no errors")
      .check([&](Table& t, P& plan) {
        take_measure(t, names, plan);
        check_target(t, names, plan);
      })
      .read(table);
}

}  // namespace haptrial::analysis::trials
