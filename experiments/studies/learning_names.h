#pragma once

#include "analysis/learning/learning_plan.h"

namespace haptrial::protocols {
struct Definition;
}

namespace haptrial::experiments {

/// Groups and sessions of a study, as its learning plan may name them.
analysis::LearningNames learning_names(const protocols::Definition& definition);

}  // namespace haptrial::experiments
