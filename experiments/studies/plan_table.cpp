#include "experiments/studies/plan_table.h"

#include <algorithm>
#include <cmath>
#include <regex>

#include "core/base/definition/schema.h"

namespace haptrial::experiments {
namespace {

void check_plan_table(Table& table, PlanTable& plan) {
  static const std::regex date("[0-9]{4}-(0[1-9]|1[0-2])-(0[1-9]|[12][0-9]|3[01])");
  if (!plan.retain_until.empty() && !std::regex_match(plan.retain_until, date)) {
    table.reject("retain_until", "'" + plan.retain_until + "'", "a date such as 2036-12-31");
  }
  const bool whole = std::ranges::all_of(
      plan.looks, [](double look) { return look >= 1.0 && look == std::floor(look); });
  if (!whole || !std::ranges::is_sorted(plan.looks)) {
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
