#pragma once

#include <span>

#include "analysis/study_outcome.h"
#include "analysis/study_questions.h"
#include "analysis/trial_score.h"

namespace haptrial::analysis {

/// Adds the tests of a study to what study_statistics() has gathered: conditions, subjects, table
/// and table_1 are there.
void add_tests(StudyStatistics& study, std::span<const TrialScore> scores,
               const StudyQuestions& questions);

}  // namespace haptrial::analysis
