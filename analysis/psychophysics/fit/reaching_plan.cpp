#include "analysis/psychophysics/fit/reaching_plan.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <utility>

#include "core/base/definition/schema.h"

namespace haptrial::analysis::trials {
namespace {

constexpr int kMostCycle = 1000;
constexpr int kMostResamples = 100'000;

bool holds(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Checks a name that the definition must have, stated or not, and takes away its "$".
void check_name(Table& table, const char* key, std::string& name,
                const std::vector<std::string>& known, bool checked) {
  name = name.starts_with('$') ? name.substr(1) : name;
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
}

constexpr std::array<std::pair<const char*, ReachQuantity>, 7> kQuantities{
    {{"error", ReachQuantity::kError},
     {"movement_time", ReachQuantity::kMovementTime},
     {"peak_speed", ReachQuantity::kPeakSpeed},
     {"direction", ReachQuantity::kDirection},
     {"area", ReachQuantity::kArea},
     {"force_compensation", ReachQuantity::kForceCompensation},
     {"throughput", ReachQuantity::kThroughput}}};

std::vector<std::string> names_of_quantities() {
  std::vector<std::string> names;
  for (const auto& [name, quantity] : kQuantities) {
    names.emplace_back(name);
  }
  return names;
}

void read_quantities(Table& table, const std::string& key, ReachingPlan& plan) {
  plan.quantities.clear();
  const std::vector<std::string> known = names_of_quantities();
  for (const std::string& name : table.texts(key)) {
    const auto at = std::find(known.begin(), known.end(), name);
    if (at == known.end()) {
      table.reject(key, fmt::format("a list with \"{}\"", name),
                   fmt::format("{}", fmt::join(known, ", ")));
      continue;
    }
    const ReachQuantity quantity = kQuantities[static_cast<std::size_t>(at - known.begin())].second;
    if (std::find(plan.quantities.begin(), plan.quantities.end(), quantity) ==
        plan.quantities.end()) {
      plan.quantities.push_back(quantity);
    }
  }
}

}  // namespace

ReachingPlan read_reaching_plan(Table& table, const ReachingNames& names) {
  using P = ReachingPlan;
  const bool checked = !names.stages.empty();  // else the definition could not be read
  return Schema<P>()
      .text("stage", &P::stage, "Stage of the reach")
      .text("start", &P::start, "Place at which reaches begin, with or without $ before its name")
      .text("target", &P::target, "Place at which reaches end, with or without $ before its name")
      .check([&](Table& t, P& plan) {
        check_name(t, "stage", plan.stage, names.stages, checked);
        check_name(t, "start", plan.start, names.places, checked);
        check_name(t, "target", plan.target, names.places, checked);
        plan.field = names.fields.empty() ? "" : names.fields.front();
        plan.cycle = std::max<std::size_t>(1, names.combinations);
      })
      .text("field", &P::field, "Field of type matrix_viscous that is learnt")
      .otherwise("the first field of type matrix_viscous")
      .check([&](Table& t, P& plan) {
        if (t.has("field") || !names.fields.empty()) {
          check_name(t, "field", plan.field, names.fields, checked);
        }
      })
      .text("clamp", &P::clamp, "Probe whose reaches are held in a channel")
      .integer("cycle", &P::cycle, 1, kMostCycle,
               "Trials of a cycle, over which reaches are averaged")
      .otherwise("combinations of the factors")
      .choice("error", &P::at_150_ms, {{"maximum", false}, {"at_150_ms", true}},
              "Error of a reach that is learnt from: the largest distance from the straight line, "
              "or the distance after 150 ms")
      .integer("resamples", &P::resamples, 0, kMostResamples, "Resamples of the bootstrap")
      .custom("quantities",
              fmt::format("Quantities of reaches that are compared between the conditions of `by`: "
                          "{}",
                          fmt::join(names_of_quantities(), ", ")),
              read_quantities)
      .otherwise("[\"error\"]")
      .choice("cycles", &P::cycles,
              {{"all", ReachCycles::kAll},
               {"first", ReachCycles::kFirst},
               {"last", ReachCycles::kLast}},
              "Cycles of each block whose reaches are compared between conditions")
      .read(table);
}

}  // namespace haptrial::analysis::trials
