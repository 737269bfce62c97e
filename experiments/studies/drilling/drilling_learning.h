#pragma once

#include "analysis/learning/learning_plan.h"

namespace haptrial {
class Table;
}

namespace haptrial::protocols {
struct BoneDefinition;
}

namespace haptrial::experiments {

/// Reads from [analysis] how a study says what was learned; problems are noted.
/// @param definition  whose table it is; null if it cannot be read
analysis::LearningPlan read_drilling_learning(Table& root,
                                              const protocols::BoneDefinition* definition);

}  // namespace haptrial::experiments
