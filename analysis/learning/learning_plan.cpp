#include "analysis/learning/learning_plan.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/base/definition/schema.h"
#include "core/base/nearest.h"

namespace haptrial::analysis {
namespace {

const Schema<LearningPlan>& learning_schema() {
  using P = LearningPlan;
  static const auto schema =
      Schema<P>()
          .texts(
              "outcomes", &P::outcomes,
              "Quantities of metrics.csv (drillings, without their units) or of scores.csv (force "
              "trainings) whose changes from session to session the report tests; the first "
              "decides")
          .otherwise("none")
          .text("baseline", &P::baseline, "Session from which changes are counted, by its name")
          .otherwise("the first that gives nothing");
  return schema;
}

void check_outcomes(Table& table, const LearningPlan& plan, const LearningOutcomes& known) {
  for (const std::string& name : plan.outcomes) {
    if (!known.is_known(name)) {
      const std::string hint = did_you_mean(name, known.names);
      table.reject("outcomes",
                   fmt::format("names '{}'{} allowed: {}", name, hint.empty() ? ";" : hint,
                               fmt::join(known.names, ", ")));
    }
  }
}

void choose_sessions(Table& table, const LearningNames& names, LearningPlan& plan) {
  if (plan.baseline.empty() && !names.tests.empty()) {
    plan.baseline = names.tests.front();
  }
  if (std::ranges::find(names.sessions, plan.baseline) == names.sessions.end()) {
    table.reject("baseline", fmt::format("\"{}\"", plan.baseline),
                 fmt::format("a session: {}", fmt::join(names.sessions, ", ")));
  }
  std::ranges::copy_if(names.tests, std::back_inserter(plan.tests),
                       [&](const std::string& test) { return test != plan.baseline; });
  if (plan.tests.empty()) {
    table.reject("outcomes",
                 "stand alone: changes need two sessions that give nothing; add gives = false to "
                 "the sessions that are tests");
  }
}

/// Names that a side of a planned test may have.
std::vector<std::string> sides_of(const LearningNames& names, const LearningPlan& plan) {
  std::vector<std::string> sides = names.groups;
  sides.insert(sides.end(), plan.tests.begin(), plan.tests.end());
  for (const std::string& group : names.groups) {
    for (const std::string& test : plan.tests) {
      sides.push_back(group + ", " + test);
    }
  }
  return sides;
}

}  // namespace

LearningPlan read_learning_plan(Table& root, const LearningNames& names,
                                const LearningOutcomes& known) {
  LearningPlan plan;
  if (!root.has("analysis")) {
    return plan;
  }
  Table analysis = root.table("analysis");
  if (!analysis.has("outcomes")) {
    return plan;
  }
  learning_schema().read(analysis, plan);
  check_outcomes(analysis, plan, known);
  choose_sessions(analysis, names, plan);
  plan.plan = read_analysis_plan(analysis, sides_of(names, plan), "the list of groups and tests");
  return plan;
}

}  // namespace haptrial::analysis
