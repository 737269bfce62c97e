#pragma once

#include <optional>
#include <span>

#include "analysis/force_training/study/study_outcome.h"
#include "analysis/force_training/study/study_questions.h"

namespace haptrial::analysis {

/// The statistics of a study's recalled paths: those of its scores with TrialScore::path_error, in
/// millimetres, in place of the score. Nothing where no path was recalled.
std::optional<StudyStatistics> path_statistics(std::span<const TrialScore> scores,
                                               const StudyQuestions& questions = {});

}  // namespace haptrial::analysis
