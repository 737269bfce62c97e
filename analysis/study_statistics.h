#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "analysis/anova.h"
#include "analysis/descriptive.h"
#include "analysis/effect_size.h"
#include "analysis/levene.h"
#include "analysis/rank_anova.h"
#include "analysis/repeated_anova.h"
#include "analysis/shapiro_wilk.h"
#include "analysis/study_mixed.h"
#include "analysis/t_test.h"
#include "analysis/trial_score.h"
#include "analysis/wilcoxon.h"

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
  Defined<TTest> pooled{Undefined{"nothing was compared"}};  // Student, one-tailed, as published
  Defined<EffectSize> pooled_d{Undefined{"nothing was compared"}};  // Cohen's d
  Defined<TTest> welch{Undefined{"nothing was compared"}};          // the same, unequal variances
  Defined<TTest> paired{Undefined{"nothing was compared"}};  // participants' means, one-tailed
  Defined<EffectSize> paired_dz{Undefined{"nothing was compared"}};
  Defined<double> paired_holm{Undefined{"nothing was compared"}};  // p of paired, over all planned
};

/// Two conditions within participants, without a hypothesis: two-tailed.
struct PairComparison {
  std::string a;
  std::string b;
  Defined<TTest> test{Undefined{"nothing was compared"}};
  Defined<double> holm{Undefined{"nothing was compared"}};  // its p, adjusted over all pairs
  Defined<EffectSize> dz{Undefined{"nothing was compared"}};
  Defined<RankTest> signed_rank{Undefined{"nothing was compared"}};
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

  StudyMixed mixed;                     // all trials, the first condition as the reference
  std::vector<Comparison> comparisons;  // visual < haptic, visuohaptic < visual, where they are
  std::vector<PairComparison> pairs;    // every two conditions

  std::vector<ParticipantMeans> table_1;  // participants with a trial in every condition
  std::vector<std::string> incomplete;    // subjects left out of table_1, `repeated` and `paired`
  std::vector<LearningPoint> learning;    // by condition, then repetition
  std::vector<BlockPoint> blocks;         // in order
  Defined<MeanInterval> slope{Undefined{"there are no trials"}};  // participants' own, a block
};

/// @param scores  in any order; the result does not depend on it but for rounding.
StudyStatistics study_statistics(std::span<const TrialScore> scores);

}  // namespace haptrial::analysis
