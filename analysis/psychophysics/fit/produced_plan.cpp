#include "analysis/psychophysics/fit/produced_plan.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "core/base/definition/schema.h"

namespace haptrial::analysis::trials {
namespace {

/// Notes a name that is not among those known. @returns its place
std::size_t require_name(Table& table, const char* key, const std::string& name,
                         const std::vector<std::string>& known) {
  const auto at = std::ranges::find(known, name);
  if (at == known.end()) {
    const bool stated = table.has(key);
    const std::string found = stated ? fmt::format("\"{}\"", name)
                                     : fmt::format("\"produced\" of the {} \"{}\"", key, name);
    const std::string lead = stated ? "" : fmt::format("{} = ", key);
    table.reject(stated ? key : "kind", found,
                 known.empty() ? std::string("none: the definition has no such name")
                               : fmt::format("{}one of: {}", lead, fmt::join(known, ", ")));
    return 0;
  }
  return static_cast<std::size_t>(at - known.begin());
}

void check_produced(Table& table, const ProducedNames& names, ProducedPlan& plan) {
  if (names.stages.empty()) {
    return;  // the definition could not be read
  }
  require_name(table, "stage", plan.stage, names.stages);
  if (!plan.device_name.empty()) {
    plan.device = require_name(table, "device", plan.device_name, names.devices);
  }
  if (!plan.target.empty()) {
    require_name(table, "target", plan.target, names.variables);
  }
  if (plan.quantity == ProducedQuantity::kPath && plan.statistic != ProducedStatistic::kMean) {
    table.reject("statistic", "given beside quantity = \"path\", which is one number",
                 "no statistic of a path");
  }
}

}  // namespace

const char* unit_of(ProducedQuantity quantity) {
  return quantity == ProducedQuantity::kForce   ? "N"
         : quantity == ProducedQuantity::kSpeed ? "m/s"
                                                : "m";
}

std::string words_of(const ProducedPlan& plan) {
  constexpr std::array kQuantities{"force",         "place along x", "place along y",
                                   "place along z", "speed",         "path"};
  constexpr std::array kStatistics{"mean", "peak", "last", "deviation of the"};
  const char* quantity = kQuantities[static_cast<std::size_t>(plan.quantity)];
  return plan.quantity == ProducedQuantity::kPath
             ? std::string(quantity)
             : fmt::format("{} {}", kStatistics[static_cast<std::size_t>(plan.statistic)],
                           quantity);
}

ProducedPlan read_produced_plan(Table& table, const ProducedNames& names) {
  using P = ProducedPlan;
  using Q = ProducedQuantity;
  using S = ProducedStatistic;
  return Schema<P>()
      .derive([&](P& plan) { plan.stage = names.stages.empty() ? "" : names.stages.back(); })
      .text("stage", &P::stage, "Stage in which something is produced")
      .otherwise("the last")
      .text("device", &P::device_name, "Device with which it is produced")
      .otherwise("the first")
      .choice("quantity", &P::quantity,
              {{"force", Q::kForce},
               {"x", Q::kX},
               {"y", Q::kY},
               {"z", Q::kZ},
               {"speed", Q::kSpeed},
               {"path", Q::kPath}},
              "What is produced: the size of the force against the device, a place along an axis, "
              "speed, or the length of the path")
      .choice(
          "statistic", &P::statistic,
          {{"mean", S::kMean}, {"peak", S::kPeak}, {"end", S::kEnd}, {"deviation", S::kDeviation}},
          "Number that stands for the stage: mean, greatest size, last value or standard "
          "deviation")
      .number("last", &P::last, {0.0, 600.0}, "s",
              "Time at the stage's end that counts, such as the last second of a held force; 0: "
              "the whole stage")
      .text("target", &P::target,
            "Variable of the trial that was to be produced, in N, m or m/s; the report then has "
            "errors")
      .otherwise("none: there are no errors")
      .check([&](Table& t, P& plan) { check_produced(t, names, plan); })
      .read(table);
}

}  // namespace haptrial::analysis::trials
