#pragma once

#include "analysis/learning/learning_plan.h"

namespace haptrial {
class Table;
}

namespace haptrial::experiments {

/// Reads from [analysis] how a study says what was learned; problems are noted.
analysis::LearningPlan read_drilling_learning(Table& root);

}  // namespace haptrial::experiments
