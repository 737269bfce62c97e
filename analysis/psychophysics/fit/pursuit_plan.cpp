#include "analysis/psychophysics/fit/pursuit_plan.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "core/base/definition/schema.h"

namespace haptrial::analysis::trials {
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

}  // namespace haptrial::analysis::trials
