#pragma once

#include <string>
#include <vector>

#include "analysis/learning/learned_study.h"

namespace haptrial::analysis {

struct StudyResult;

/// The outcomes that the learning plan of a force training may name: columns of scores.csv.
LearningOutcomes score_outcomes();

/// The values of outcomes in all sessions, those that train and those that test.
std::vector<LearningQuantity> learned_scores(const StudyResult& study,
                                             const std::vector<std::string>& outcomes);

/// The scores of all sessions as a table: subject, group, session, trial, and each outcome.
std::string session_scores_csv(const StudyResult& study);

}  // namespace haptrial::analysis
