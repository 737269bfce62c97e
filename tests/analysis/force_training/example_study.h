#pragma once

#include <string>

#include "analysis/force_training/study/study_result.h"

namespace haptrial::analysis {

/// A small study made up in memory, every part of it filled: six participants with three
/// conditions, two blocks of three repetitions each. Deterministic.
StudyResult example_study(bool simulated);

}  // namespace haptrial::analysis
