#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/statistics/design/analysis_plan.h"
#include "core/base/definition/schema_forward.h"

namespace haptrial::analysis {

/// Groups and sessions of a definition, which a learning plan may name.
struct LearningNames {
  std::vector<std::string> groups;    // in their order; one if everybody is alike
  std::vector<std::string> sessions;  // in their order
  std::vector<std::string> tests;     // sessions that give nothing, in their order
};

/// Quantities of trials that a learning plan may name.
struct LearningOutcomes {
  std::vector<std::string> names;                  // for sentences
  std::function<bool(std::string_view)> is_known;  // whether a name may be one
};

/// How a study over several sessions says what was learned: [analysis] of a definition.
struct LearningPlan {
  std::vector<std::string> outcomes;  // quantities of trials, the decisive one first; or none
  std::string baseline;               // session from which changes are counted
  std::vector<std::string> tests;     // sessions up to which they are, in their order
  /// Planned tests compare changes: sides are groups, tests, or "GROUP, TEST". Their directions are
  /// those of the first outcome.
  AnalysisPlan plan;
};

/// Reads the keys `outcomes`, `baseline` and `planned` of [analysis], and those that tests have
/// beside them, if `outcomes` is there; problems are noted.
LearningPlan read_learning_plan(Table& root, const LearningNames& names,
                                const LearningOutcomes& known);

}  // namespace haptrial::analysis
