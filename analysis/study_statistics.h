#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "analysis/anova.h"
#include "analysis/descriptive.h"
#include "analysis/repeated_anova.h"
#include "analysis/t_test.h"
#include "analysis/trial_score.h"

namespace haptrial::analysis {

/// Recall error of one training condition.
struct ConditionSummary {
  std::string condition;
  std::size_t count{0};                                            // trials
  Defined<double> mean{Undefined{"there are no trials"}};          // over trials
  Defined<MeanInterval> trials{Undefined{"there are no trials"}};  // pooled, as published
  Defined<MeanInterval> participants{Undefined{"there are no participants"}};  // of their means
};

/// One participant's mean recall error in each condition, and what came of it.
struct ParticipantMeans {
  std::string subject;
  std::vector<double> means;  // (conditions), only where every condition has a trial
  std::string best;           // condition of the lowest mean; several joined by " and "
  std::string worst;
};

/// The hypothesis that `better` has the lower mean error than `worse`.
struct Comparison {
  std::string better;
  std::string worse;
  Defined<TTest> pooled{Undefined{"a condition is missing"}};  // Student, one-tailed, as published
  Defined<TTest> welch{Undefined{"a condition is missing"}};   // the same, unequal variances
  Defined<TTest> paired{Undefined{"a condition is missing"}};  // participants' means, one-tailed
  Defined<double> paired_holm{Undefined{"a condition is missing"}};  // its p, adjusted over all
};

/// Mean error of a condition at a repetition within the block.
struct LearningPoint {
  std::string condition;
  std::int32_t repetition{0};
  std::size_t participants{0};
  Defined<double> mean{Undefined{"there are no participants"}};  // of the participants' means
  Defined<MeanInterval> interval{Undefined{"there are no participants"}};
};

/// Source: Morris 2006, §4.4.
struct StudyStatistics {
  std::vector<std::string> subjects;    // in order of name
  std::vector<std::string> conditions;  // haptic, visual, visuohaptic, then others by name
  std::vector<ConditionSummary> summaries;
  Defined<Anova> anova{Undefined{"there are no trials"}};             // pooled trials, as published
  Defined<RepeatedAnova> repeated{Undefined{"there are no trials"}};  // participants' means
  std::vector<Comparison> comparisons;    // visual < haptic, visuohaptic < visual
  std::vector<ParticipantMeans> table_1;  // participants with a trial in every condition
  std::vector<std::string> incomplete;    // subjects left out of table_1, `repeated` and `paired`
  std::vector<LearningPoint> learning;    // by condition, then repetition
};

/// @param scores  in any order; the result does not depend on it but for rounding.
StudyStatistics study_statistics(std::span<const TrialScore> scores);

}  // namespace haptrial::analysis
