#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/force_training/score/trial_score.h"
#include "analysis/force_training/study/study_mixed.h"
#include "analysis/statistics/base/descriptive.h"
#include "analysis/statistics/base/resampling.h"
#include "analysis/statistics/design/analysis_plan.h"
#include "analysis/statistics/design/design_tests.h"
#include "analysis/statistics/tests/shapiro_wilk.h"
#include "analysis/statistics/tests/t_tests.h"
#include "analysis/statistics/variance/anova.h"
#include "analysis/statistics/variance/rank_anova.h"
#include "analysis/statistics/variance/repeated_anova.h"

namespace haptrial::analysis {

/// Recall error of one training condition.
struct ConditionSummary {
  std::string condition;
  std::size_t count{0};                                            // trials
  std::size_t people{0};                                           // participants with such a trial
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

/// A planned test as published: single trials, pooled over participants.
struct PooledComparison {
  PlannedTest sides;
  Defined<TTest> student{Undefined{"nothing was compared"}};
  Defined<TTest> welch{Undefined{"nothing was compared"}};   // the same, unequal variances
  Defined<EffectSize> d{Undefined{"nothing was compared"}};  // Cohen's
};

/// Mean error of a condition at a repetition within the block.
struct LearningPoint {
  std::string condition;
  std::int32_t repetition{0};
  std::size_t participants{0};
  Defined<double> mean{Undefined{"there are no participants"}};  // of the participants' means
  Defined<MeanInterval> interval{Undefined{"there are no participants"}};
};

/// Mean error of the participants in their n-th block.
struct BlockPoint {
  std::int32_t block{0};
  std::size_t participants{0};
  Defined<double> mean{Undefined{"there are no participants"}};  // of the participants' means
  Defined<MeanInterval> interval{Undefined{"there are no participants"}};
};

/// Source: Morris 2006, §4.4.
struct StudyStatistics {
  std::vector<std::string> subjects;    // in order of name
  std::vector<std::string> conditions;  // haptic, visual, visuohaptic, then others by name
  std::vector<ConditionSummary> summaries;

  // Pooled trials, as published.
  Defined<Anova> anova{Undefined{"there are no trials"}};
  Defined<EffectSize> eta{Undefined{"there are no trials"}};  // squared
  Defined<RankAnova> ranks{Undefined{"there are no trials"}};
  Defined<Anova> levene{Undefined{"there are no trials"}};           // about the medians
  Defined<ShapiroWilk> normality{Undefined{"there are no trials"}};  // less their condition's mean

  // Participants' means.
  Defined<RepeatedAnova> repeated{Undefined{"there are no trials"}};
  Defined<EffectSize> partial_eta{Undefined{"there are no trials"}};  // squared
  Defined<double> generalized_eta{Undefined{"there are no trials"}};  // squared
  Defined<RankAnova> friedman{Undefined{"there are no trials"}};

  StudyMixed mixed;  // all trials, the first condition as the reference

  // Tests that the design calls for, with participants as the unit: the report leads with these.
  DesignTable table;
  DesignTests tests;

  std::vector<PooledComparison> comparisons;  // the planned tests again, as published

  std::vector<ParticipantMeans> table_1;  // participants with a trial in every condition
  std::vector<LearningPoint> learning;    // by condition, then repetition
  std::vector<BlockPoint> blocks;         // in order
  Defined<MeanInterval> slope{Undefined{"there are no trials"}};  // participants' own, a block
};

/// Questions of a study besides its scores.
struct StudyQuestions {
  AnalysisPlan plan{};
  std::vector<std::string> factors{"condition"};  // names, one for each of TrialScore::levels
  Resampling resampling{1, "", 0, 1};             // of permutation tests and bootstrap; 0: none
};

/// Questions of a report: with permutation tests and bootstrap intervals.
StudyQuestions questions_of(const std::vector<std::string>& factors, const AnalysisPlan& plan,
                            int threads);

/// Scores picked out of a study's, for its statistics.
using Values = std::vector<double>;

/// The scores of which `wanted` holds, in the order given.
template <class Predicate>
Values scores_where(std::span<const TrialScore> scores, Predicate&& wanted) {
  Values result;
  for (const auto& score : scores) {
    if (wanted(score)) {
      result.push_back(score.score);
    }
  }
  return result;
}

inline Values of_condition(std::span<const TrialScore> scores, const std::string& condition) {
  return scores_where(scores, [&](const auto& s) { return s.condition == condition; });
}

/// The same by subject, in order of name.
template <class Predicate>
std::map<std::string, Values> by_subject_where(std::span<const TrialScore> scores,
                                               Predicate&& wanted) {
  std::map<std::string, Values> result;
  for (const auto& score : scores) {
    if (wanted(score)) {
      result[score.subject].push_back(score.score);
    }
  }
  return result;
}

/// @param scores  in any order; the result does not depend on it but for rounding.
StudyStatistics study_statistics(std::span<const TrialScore> scores,
                                 const StudyQuestions& questions = {});

/// The statistics of a study's recalled paths: those of its scores with TrialScore::path_error, in
/// millimetres, in place of the score. Nothing where no path was recalled.
std::optional<StudyStatistics> path_statistics(std::span<const TrialScore> scores,
                                               const StudyQuestions& questions = {});

}  // namespace haptrial::analysis
