#pragma once

#include <span>

#include "analysis/force_training/score/trial_score.h"
#include "analysis/force_training/study/study_outcome.h"
#include "analysis/force_training/study/study_questions.h"

namespace haptrial::analysis {

/// Adds the tests of a study to what study_statistics() has gathered: conditions, subjects, table
/// and table_1 are there.
void add_tests(StudyStatistics& study, std::span<const TrialScore> scores,
               const StudyQuestions& questions);

}  // namespace haptrial::analysis
