#include "experiments/studies/power_plan.h"

#include <algorithm>

#include "core/base/definition/table.h"

namespace haptrial::experiments {
namespace {

constexpr long kMostReplications = 1'000'000;

VariedKey read_vary(Table& table) {
  VariedKey varied;
  varied.key = table.text("key");
  varied.values = table.numbers("values", {}, "");
  if (table.has("none")) {
    varied.none = table.number("none", {}, "");
  }
  if (varied.key.empty() || varied.key.front() == '.' || varied.key.back() == '.' ||
      varied.key.find('.') == std::string::npos) {
    table.reject("key", "'" + varied.key + "'", "a key with its table, such as observer.lapse");
  }
  std::vector<double> sorted = varied.values;
  std::sort(sorted.begin(), sorted.end());
  if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) {
    table.reject("values", "a list with a value twice", "each value once");
  }
  return varied;
}

}  // namespace

PowerPlan read_power_plan(Table& root) {
  PowerPlan plan;
  Table table = root.table("power");
  if (table.has("definition")) {
    plan.definition = table.text("definition");
  }
  plan.watch = table.text("watch");
  plan.alpha = table.number_or("alpha", plan.alpha, {1e-6, 0.5}, "");
  plan.target = table.number_or("target", plan.target, {0.01, 0.9999}, "");
  plan.replications = table.integer_or("replications", plan.replications, 1, kMostReplications);
  plan.null_replications =
      table.integer_or("null_replications", plan.null_replications, 1, kMostReplications);
  plan.block = table.integer_or("block", plan.block, 1, kMostReplications);
  plan.seed = static_cast<std::uint64_t>(table.integer_or("seed", 1, 0, 2'000'000'000));
  if (table.has("depth")) {
    plan.depth = table.choice("depth", {"responses", "sessions"}) == "sessions"
                     ? PowerDepth::kSessions
                     : PowerDepth::kResponses;
  }
  if (plan.depth == PowerDepth::kSessions && !table.has("block")) {
    plan.block = 1;  // full sessions take long
  }
  if (table.has("check")) {
    Table check = table.table("check");
    plan.checked_cells = static_cast<int>(check.integer("cells", 0, 1000));
    plan.checked_replications =
        check.integer_or("replications", plan.checked_replications, 2, 100'000);
  }
  table.leave("responses");
  for (Table& each : table.tables("vary")) {
    plan.vary.push_back(read_vary(each));
  }
  return plan;
}

}  // namespace haptrial::experiments
