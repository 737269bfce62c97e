#pragma once

#include "experiments/studies/study.h"

namespace haptrial::experiments {

/// Experiments that a definition states whole, and what they tell of perception and movement.
const Study& trials_study();

}  // namespace haptrial::experiments
