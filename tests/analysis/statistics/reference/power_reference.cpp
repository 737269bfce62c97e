#include <fmt/format.h>

#include <utility>

#include "analysis/statistics/tests/power.h"
#include "tests/analysis/statistics/reference/reference.h"

namespace haptrial::analysis::reference::power_reference {
namespace {

void compare_t(Answers& r, const std::string& name, TPlan plan) {
  const char* const procedure = "Power of t-tests";
  for (const double n : {2.0, 5.0, 17.0, 60.0}) {
    for (const double delta : {0.1, 0.5, 1.3}) {
      r.at(procedure, fmt::format("{} {:g} {:g}", name, n, delta))
          .is("power", *t_power(plan, n, delta));
    }
  }
  TPlan strict = plan;
  strict.alpha = 0.001;
  r.at(procedure, name)
      .is("n", t_sample_size(plan, 0.5, 0.8)->exact)
      .is("n_small", t_sample_size(plan, 0.05, 0.95)->exact)
      .is("delta", *t_detectable(plan, 12.0, 0.8))
      .is("n_strict", t_sample_size(strict, 0.7, 0.9)->exact);
}

void compare_anova(Answers& r, int groups) {
  const AnovaPlan plan{groups, 0.05};
  const char* const procedure = "Power of one-way ANOVA";
  for (const double n : {2.0, 8.0, 40.0}) {
    for (const double f : {0.1, 0.25, 0.8}) {
      r.at(procedure, fmt::format("{} {:g} {:g}", groups, n, f))
          .is("power", *anova_power(plan, n, f));
    }
  }
  r.at(procedure, std::to_string(groups))
      .is("n", anova_sample_size(plan, 0.25, 0.8)->exact)
      .is("f", *anova_detectable(plan, 15.0, 0.9));
}

void compare_repeated(Answers& r, const std::string& term, RepeatedPlan plan) {
  const char* const procedure = "Power of repeated measures and mixed designs";
  const std::string name = fmt::format("{} {} {:g}", term, plan.measurements, plan.epsilon);
  r.at(procedure, name).is("n", repeated_sample_size(plan, 0.25, 0.8)->exact);
  for (const double n : {6.0, 25.0}) {
    for (const double correlation : {0.0, 0.5, 0.8}) {
      plan.correlation = correlation;
      r.at(procedure, fmt::format("{} {:g} {:g}", name, n, correlation))
          .is("power", *repeated_power(plan, n, 0.25));
    }
  }
}

void compare(Answers& r) {
  for (const bool one_tailed : {false, true}) {
    const std::string tails = one_tailed ? " one.sided" : " two.sided";
    compare_t(r, "two.sample" + tails, {TDesign::kTwoSample, 0.05, one_tailed});
    compare_t(r, "one.sample" + tails, {TDesign::kOneSample, 0.05, one_tailed});
    compare_t(r, "paired" + tails, {TDesign::kPaired, 0.05, one_tailed});
  }
  for (const int groups : {2, 3, 6}) {
    compare_anova(r, groups);
  }
  for (const auto& [term, word] : {std::pair(RepeatedTerm::kWithin, "within"),
                                   {RepeatedTerm::kInteraction, "interaction"},
                                   {RepeatedTerm::kBetween, "between"}}) {
    compare_repeated(r, word, {term, 2, 2, 0.5, 1.0, 0.05});
    compare_repeated(r, word, {term, 2, 4, 0.5, 1.0, 0.05});
    compare_repeated(r, word, {term, 2, 4, 0.5, 0.6, 0.05});
  }
}

const Topic kTopic("power", compare);

}  // namespace
}  // namespace haptrial::analysis::reference::power_reference
