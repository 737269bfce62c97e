#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "analysis/bone_drilling/report/validity_study.h"
#include "analysis/learning/learning_plan.h"
#include "core/base/definition/schema_forward.h"
#include "experiments/studies/drilling/procedure_setup.h"
#include "experiments/studies/study.h"
#include "protocols/bone_drilling/definition/bone_definition.h"
#include "protocols/definition/groups.h"

namespace haptrial::experiments {

/// The name of the ratings within a study's folder.
inline constexpr const char* kRatingsFile = "ratings.csv";
/// The names of a checklist that raters were given, and of the points that they gave.
inline constexpr const char* kChecklistFile = "checklist.toml";
inline constexpr const char* kCheckedFile = "checklist.csv";

/// Analyses drilling sessions. Ratings are in their folder.
/// @returns lines for the terminal
std::vector<std::string> analyze_drillings(const AnalysisRequest& request);

/// Reads from [analysis] how a study says what was learned; problems are noted.
/// @param definition  whose table it is; null if it cannot be read
analysis::LearningPlan read_drilling_learning(Table& root,
                                              const protocols::BoneDefinition* definition);

}  // namespace haptrial::experiments
