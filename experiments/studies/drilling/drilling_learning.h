#pragma once

#include "analysis/bone_drilling/report/learning_plan.h"
#include "protocols/bone_drilling/definition/bone_definition.h"

namespace haptrial::experiments {

/// Groups and sessions of a study, as its learning plan may name them.
analysis::drilling::LearningNames learning_names(const protocols::BoneDefinition& definition);

/// Reads from [analysis] how a study says what was learned; problems are noted.
analysis::drilling::LearningPlan read_drilling_learning(Table& root);

}  // namespace haptrial::experiments
