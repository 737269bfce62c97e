#include "analysis/psychophysics/fit/method_plans.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <utility>

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

namespace {

void check_names(Table& table, const PursuitNames& names, PursuitPlan& plan) {
  if (std::ranges::find(names.stages, plan.stage) == names.stages.end()) {
    table.reject(table.has("stage") ? "stage" : "kind",
                 fmt::format("of the stage \"{}\"", plan.stage),
                 fmt::format("stage = one of: {}", fmt::join(names.stages, ", ")));
  }
  const auto target = std::ranges::find(names.targets, plan.target, &PursuedTarget::name);
  if (target == names.targets.end()) {
    std::vector<std::string> known;
    std::ranges::transform(names.targets, std::back_inserter(known), &PursuedTarget::name);
    table.reject(table.has("target") ? "target" : "kind",
                 fmt::format("of the target \"{}\"", plan.target),
                 known.empty() ? "a definition with [targets]"
                               : fmt::format("target = one of: {}", fmt::join(known, ", ")));
    return;
  }
  plan.number = static_cast<std::size_t>(target - names.targets.begin());
  plan.frequencies = target->frequencies;
  plan.swing = target->frequencies;
}

/// Gain and lag exist only at frequencies that the target has.
void check_frequencies(Table& table, PursuitPlan& plan) {
  const std::vector<double> known = std::exchange(plan.swing, plan.frequencies);
  for (const double frequency : plan.frequencies) {
    if (!known.empty() && std::ranges::find(known, frequency) == known.end()) {
      table.reject(
          "frequencies", fmt::format("with {:g} Hz", frequency),
          fmt::format("frequencies of the target {}: {:g}", plan.target, fmt::join(known, ", ")));
    }
  }
  for (const double frequency : known) {
    if (std::ranges::find(plan.frequencies, frequency) == plan.frequencies.end()) {
      plan.swing.push_back(frequency);
    }
  }
}

}  // namespace

PursuitPlan read_pursuit_plan(Table& table, const PursuitNames& names) {
  using P = PursuitPlan;
  return Schema<P>()
      .text("stage", &P::stage, "Stage in which the target is pursued")
      .derive([&](P& plan) { plan.target = names.first; })
      .text("target", &P::target, "Target that is pursued")
      .otherwise("the first")
      .check([&](Table& t, P& plan) {
        if (!names.stages.empty()) {  // else the definition could not be read
          check_names(t, names, plan);
        }
      })
      .number("settle", &P::settle, {0.0, 600.0}, "s",
              "Time from the beginning of a pursuit that is left out of its analysis")
      .numbers("frequencies", &P::frequencies, {0.001, 20.0}, "Hz",
               "Frequencies at which gain and lag of a pursuit are found")
      .otherwise("the target's")
      .check(check_frequencies)
      .read(table);
}

PairedPlan read_paired_plan(Table& table, const std::vector<std::string>& known) {
  using P = PairedPlan;
  const auto check = [&](Table& t, const char* key, const std::string& name) {
    if (!name.empty() && !known.empty() && std::ranges::find(known, name) == known.end()) {
      t.reject(key, fmt::format("\"{}\"", name),
               fmt::format("a factor or variable: {}", fmt::join(known, ", ")));
    }
  };
  return Schema<P>()
      .text("first", &P::first, "Factor or variable that names the item of the first interval")
      .required()
      .text("second", &P::second, "Factor or variable that names the item of the second interval")
      .required()
      .choice(
          "model", &P::model,
          {{"Bradley-Terry", PairedModel::kBradleyTerry}, {"Thurstone", PairedModel::kThurstone}},
          "Model of the choices: worths in log odds, or in standard deviations of a difference")
      .check([&](Table& t, P& plan) {
        check(t, "first", plan.first);
        check(t, "second", plan.second);
      })
      .read(table);
}

}  // namespace haptrial::analysis::trials
