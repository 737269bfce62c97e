#include "analysis/psychophysics/fit/reaching_plan.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <utility>

#include "core/base/definition/table.h"

namespace haptrial::analysis::trials {
namespace {

constexpr int kMostCycle = 1000;
constexpr int kMostResamples = 100'000;

bool holds(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// A name that the definition must have, stated or not.
std::string named(Table& table, const char* key, const std::string& otherwise,
                  const std::vector<std::string>& known, bool checked) {
  std::string name = table.has(key) ? table.text(key) : otherwise;
  const bool dollar = name.starts_with('$');
  name = dollar ? name.substr(1) : name;
  if (checked && !holds(known, name)) {
    const std::string allowed = known.empty() ? std::string("none, the definition has none")
                                              : fmt::format("{}", fmt::join(known, ", "));
    if (table.has(key)) {
      table.reject(key, fmt::format("\"{}\"", name), allowed);
    } else {
      table.reject("kind", fmt::format("\"reaching\" with {} = \"{}\"", key, name),
                   fmt::format("{} = one of: {}", key, allowed));
    }
  }
  return name;
}

constexpr std::array<std::pair<const char*, ReachQuantity>, 6> kQuantities{
    {{"error", ReachQuantity::kError},
     {"movement_time", ReachQuantity::kMovementTime},
     {"peak_speed", ReachQuantity::kPeakSpeed},
     {"direction", ReachQuantity::kDirection},
     {"area", ReachQuantity::kArea},
     {"force_compensation", ReachQuantity::kForceCompensation}}};

void read_comparison(Table& table, ReachingPlan& plan) {
  if (table.has("quantities")) {
    plan.quantities.clear();
    std::vector<std::string> known;
    for (const auto& [name, quantity] : kQuantities) {
      known.emplace_back(name);
    }
    for (const std::string& name : table.texts("quantities")) {
      const auto at = std::find(known.begin(), known.end(), name);
      if (at == known.end()) {
        table.reject("quantities", fmt::format("a list with \"{}\"", name),
                     fmt::format("{}", fmt::join(known, ", ")));
        continue;
      }
      const ReachQuantity quantity =
          kQuantities[static_cast<std::size_t>(at - known.begin())].second;
      if (std::find(plan.quantities.begin(), plan.quantities.end(), quantity) ==
          plan.quantities.end()) {
        plan.quantities.push_back(quantity);
      }
    }
  }
  if (table.has("cycles")) {
    const std::string word = table.choice("cycles", {"all", "first", "last"});
    plan.cycles = word == "first"  ? ReachCycles::kFirst
                  : word == "last" ? ReachCycles::kLast
                                   : ReachCycles::kAll;
  }
}

}  // namespace

ReachingPlan read_reaching_plan(Table& table, const ReachingNames& names) {
  ReachingPlan plan;
  const bool checked = !names.stages.empty();  // else the definition could not be read
  plan.stage = named(table, "stage", plan.stage, names.stages, checked);
  plan.start = named(table, "start", plan.start, names.places, checked);
  plan.target = named(table, "target", plan.target, names.places, checked);
  if (table.has("field") || !names.fields.empty()) {
    plan.field = named(table, "field", names.fields.empty() ? "" : names.fields.front(),
                       names.fields, checked);
  }
  if (table.has("clamp")) {
    plan.clamp = table.text("clamp");
  }
  plan.cycle = std::max<std::size_t>(1, names.combinations);
  if (table.has("cycle")) {
    plan.cycle = static_cast<std::size_t>(table.integer("cycle", 1, kMostCycle));
  }
  if (table.has("error")) {
    plan.at_150_ms = table.choice("error", {"maximum", "at_150_ms"}) == "at_150_ms";
  }
  if (table.has("resamples")) {
    plan.resamples = static_cast<std::size_t>(table.integer("resamples", 0, kMostResamples));
  }
  read_comparison(table, plan);
  return plan;
}

}  // namespace haptrial::analysis::trials
