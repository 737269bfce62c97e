#include "analysis/statistics/design/sequential_plan.h"

#include <algorithm>
#include <cmath>

#include "core/base/definition/schema.h"

namespace haptrial::analysis {
namespace {

bool by_factor(const SequentialPlan& plan) { return plan.rule == StopRule::kBayesFactor; }
bool by_looks(const SequentialPlan& plan) { return plan.rule == StopRule::kGroupSequential; }

void check_looks(Table& table, SequentialPlan& plan) {
  if (!by_looks(plan)) {
    return;
  }
  const bool whole = std::ranges::all_of(plan.looks, [](double n) { return n == std::floor(n); });
  if (!whole || plan.looks.empty() ||
      std::ranges::adjacent_find(plan.looks, std::greater_equal<>()) != plan.looks.end()) {
    table.reject("looks", "not such a list", "an array of ascending whole numbers of participants");
    plan.looks.clear();
  }
}

}  // namespace

const Schema<SequentialPlan>& sequential_schema() {
  using P = SequentialPlan;
  static const auto schema =
      Schema<P>()
          .choice(
              "rule", &P::rule,
              {{"bayes factor", StopRule::kBayesFactor},
               {"group sequential", StopRule::kGroupSequential}},
              "When the study ends for an effect: when the Bayes factor of the test reaches 1 / "
              "error, after any participant from the fewest on, or when its t-test passes the "
              "bound of a look")
          .text("test", &P::test, "The planned test that decides, as it is stated there")
          .otherwise("the first planned test")
          .text("of", &P::of, "The quantity whose test decides, by its name in results.json")
          .otherwise("that of tests_of, else the first that is compared")
          .number(
              "error", &P::error, {0.001, 0.2}, "1",
              "Probability with which a study without an effect may end for one, over all looks")
          .number("none", &P::none, {0.0, 1e6}, "1",
                  "Bayes factor against an effect at which the study ends without one; 0: it goes "
                  "on to its last participant")
          .only_if(by_factor)
          .integer("fewest", &P::fewest, 2, 100'000,
                   "Participants who come before the Bayes factor is looked at: of a few it is "
                   "easily against an effect that there is")
          .only_if(by_factor)
          .numbers(
              "looks", &P::looks, {2.0, 100'000.0}, "1",
              "Numbers of participants after which the test is looked at; the last is the most "
              "that come")
          .only_if(by_looks)
          .required()
          .choice("spending", &P::spending,
                  {{"O'Brien-Fleming", Spending::kOBrienFleming}, {"Pocock", Spending::kPocock}},
                  "How the error is spent over the looks: little at the early ones, or about the "
                  "same at each")
          .only_if(by_looks)
          .check(check_looks);
  return schema;
}

}  // namespace haptrial::analysis
