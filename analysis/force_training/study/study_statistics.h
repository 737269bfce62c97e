#pragma once

#include <span>

#include "analysis/force_training/score/trial_score.h"
#include "analysis/force_training/study/study_outcome.h"
#include "analysis/force_training/study/study_questions.h"

namespace haptrial::analysis {

/// @param scores  in any order; the result does not depend on it but for rounding.
StudyStatistics study_statistics(std::span<const TrialScore> scores,
                                 const StudyQuestions& questions = {});

}  // namespace haptrial::analysis
