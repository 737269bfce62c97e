#pragma once

#include <span>

#include "analysis/study_outcome.h"
#include "analysis/study_questions.h"
#include "analysis/trial_score.h"

namespace haptrial::analysis {

/// @param scores  in any order; the result does not depend on it but for rounding.
StudyStatistics study_statistics(std::span<const TrialScore> scores,
                                 const StudyQuestions& questions = {});

}  // namespace haptrial::analysis
