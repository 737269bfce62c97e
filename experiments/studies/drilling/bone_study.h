#pragma once

#include "experiments/studies/study.h"

namespace haptrial::experiments {

/// Work on simulated bone, and what it tells of whoever did it (Morris 2006, §3 and §8.2.2).
const Study& bone_study();

}  // namespace haptrial::experiments
