#pragma once

#include <string>

#include "analysis/psychophysics/study/trials_result.h"

namespace haptrial::analysis::trials {

/// A tidy table with a row for every reach: who, which trial, its kind (plain, catch, clamp), how
/// it went. Lateral columns are positive to the left of the way from start to target, seen from
/// above; `push` is the side (1 left, -1 right) to which the participant's field pushes. Units are
/// in the names; what is not defined is empty. Empty text without an analysis of reaches.
std::string reaches_csv(const TrialsResult& result);

}  // namespace haptrial::analysis::trials
