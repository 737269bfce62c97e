#include "experiments/studies/power_plan.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <regex>

#include "core/base/definition/schema.h"

namespace haptrial::experiments {
namespace {

constexpr long kMostReplications = 1'000'000;
constexpr const char* kRobust = "robust";  // a key of version 0.2, in recordings

void check_vary(Table& table, VariedKey& varied) {
  if (varied.key.empty() || varied.key.front() == '.' || varied.key.back() == '.' ||
      varied.key.find('.') == std::string::npos) {
    table.reject("key", "'" + varied.key + "'", "a key with its table, such as observer.lapse");
  }
  std::vector<double> sorted = varied.values;
  std::sort(sorted.begin(), sorted.end());
  if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) {
    table.reject("values", "a list with a value twice", "each value once");
  }
}

const Schema<VariedKey>& vary_schema() {
  using V = VariedKey;
  static const auto schema =
      Schema<V>()
          .text("key", &V::key, "Key that is varied, with its tables: observer.lapse.median")
          .required()
          .numbers("values", &V::values, {}, "", "Values of the varied key, each once")
          .required()
          .number("none", &V::none, {}, "", "Value of the varied key without an effect")
          .otherwise("it makes no effect")
          .check(check_vary);
  return schema;
}

const Schema<PowerPlan>& check_schema() {
  using P = PowerPlan;
  static const auto schema =
      Schema<P>()
          .integer("cells", &P::checked_cells, 0, 1000,
                   "Cells that are also simulated in full, as a check of the responses")
          .required()
          .integer("replications", &P::checked_replications, 2, 100'000,
                   "Studies of each cell that are simulated in full");
  return schema;
}

const Schema<PowerPlan>& power_schema() {
  using P = PowerPlan;
  static const auto schema =
      Schema<P>()
          .text("definition", &P::definition,
                "File of the definition whose power a file with [power] alone asks about")
          .otherwise("this file")
          .text("watch", &P::watch, "Name of the test of the report whose power is asked for")
          .required()
          .number("alpha", &P::alpha, {1e-6, 0.5}, "",
                  "Significance level: an effect counts as found if p is below it")
          .number("target", &P::target, {0.01, 0.9999}, "",
                  "Power for which the participants are counted")
          .integer("replications", &P::replications, 1, kMostReplications,
                   "Simulated studies of each cell")
          .integer("null_replications", &P::null_replications, 1, kMostReplications,
                   "Simulated studies of each cell without an effect")
          .integer(
              "block", &P::block, 1, kMostReplications,
              "Simulated studies of a part, the unit that is shared out; of full sessions 1 if "
              "left out")
          .integer("seed", &P::seed, 0, 2'000'000'000, "Seed of every random number of a run")
          .choice("depth", &P::depth,
                  {{"responses", PowerDepth::kResponses}, {"sessions", PowerDepth::kSessions}},
                  "Depth of the simulation: responses alone, or full sessions of each participant")
          .check([](Table& table, P& plan) {
            if (plan.depth == PowerDepth::kSessions && !table.has("block")) {
              plan.block = 1;  // full sessions take long
            }
          })
          .custom("check", "Comparison of simulated responses with full sessions",
                  [](Table& table, const std::string& key, P& plan) {
                    Table check = table.table(key);
                    check_schema().read(check, plan);
                  })
          .custom("responses",
                  "Facts of the study that simulated responses need (docs/guide-power.md)",
                  [](Table& table, const std::string& key, P&) { table.leave(key); })
          .otherwise("nothing is known")
          .custom("vary", "Keys of the definition that are varied",
                  [](Table& table, const std::string& key, P& plan) {
                    for (Table& each : table.tables(key)) {
                      plan.vary.push_back(vary_schema().read(each));
                    }
                  })
          .required();
  return schema;
}

}  // namespace

PowerPlan read_power_plan(Table& root) {
  Table table = root.table("power");
  table.pass_over(kRobust);
  return power_schema().read(table);
}

void check_new_power(Table& root) {
  Table table = root.table("power");
  if (table.has(kRobust)) {
    table.reject(kRobust,
                 "is a key of version 0.2 alone; vary what may go wrong with [[power.vary]]");
  }
}

namespace {

/// Whether it is a day of the calendar, as 2036-12-31.
bool is_date(const std::string& text) {
  static const std::regex form("([0-9]{4})-([0-9]{2})-([0-9]{2})");
  std::smatch parts;
  return std::regex_match(text, parts, form) &&
         std::chrono::year_month_day(std::chrono::year(std::stoi(parts[1])),
                                     std::chrono::month(static_cast<unsigned>(std::stoi(parts[2]))),
                                     std::chrono::day(static_cast<unsigned>(std::stoi(parts[3]))))
             .ok();
}

void check_plan_table(Table& table, PlanTable& plan) {
  if (!plan.retain_until.empty() && !is_date(plan.retain_until)) {
    table.reject("retain_until", "'" + plan.retain_until + "'", "a date such as 2036-12-31");
  }
  const bool whole = std::ranges::all_of(
      plan.looks, [](double look) { return look >= 1.0 && look == std::floor(look); });
  if (!whole || std::ranges::adjacent_find(plan.looks, std::greater_equal()) != plan.looks.end()) {
    table.reject("looks", "a list with another number", "whole numbers of participants, rising");
  }
  if (plan.effect && *plan.effect == 0.0) {
    table.reject("effect", "0", "a number other than 0");
  }
}

const Schema<PlanTable>& plan_schema() {
  using P = PlanTable;
  static const auto schema =
      Schema<P>()
          .texts("hypotheses", &P::hypotheses, "Sentences that the study is to test")
          .otherwise("none is stated beside the planned tests")
          .texts("exclusions", &P::exclusions,
                 "Reasons for which a participant is excluded; a reason that is typed later counts "
                 "as stated if it has one of these words in it")
          .otherwise("nobody is to be excluded")
          .text("stopping", &P::stopping, "Rule by which data collection ends, in words")
          .otherwise("when the planned participants have had every session")
          .numbers("looks", &P::looks, {1.0, 100'000.0}, "",
                   "Numbers of participants at which the data is analysed before the end")
          .otherwise("it is analysed at the end alone")
          .text("retain_until", &P::retain_until,
                "Date until which the data is kept, such as 2036-12-31; afterwards roster says so")
          .otherwise("no date is stated")
          .number("effect", &P::effect, {-100.0, 100.0}, "",
                  "Standardized effect that a t test is to find: difference of means by the "
                  "standard deviation (of the differences, if paired)")
          .otherwise("power is not stated, unless a simulation is given")
          .choice("design", &P::design,
                  {{"paired", PlannedDesign::kPaired},
                   {"two-sample", PlannedDesign::kTwoSample},
                   {"one-sample", PlannedDesign::kOneSample}},
                  "Design of the t test that is to find the effect, two-tailed")
          .number("alpha", &P::alpha, {1e-6, 0.5}, "", "Significance level of that t test")
          .check(check_plan_table);
  return schema;
}

}  // namespace

PlanTable read_plan_table(Table& root) {
  if (!root.has("plan")) {
    return {};
  }
  Table table = root.table("plan");
  return plan_schema().read(table);
}

}  // namespace haptrial::experiments
