#pragma once

#include "experiments/studies/study.h"

namespace haptrial::experiments {

/// Training and recall of forces along a path (Morris 2006, §4).
const Study& force_study();

}  // namespace haptrial::experiments
