#include "analysis/study_statistics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "core/base/random.h"

namespace haptrial::analysis {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TrialScore trial(const std::string& subject, const std::string& condition, std::int32_t repetition,
                 double score) {
  TrialScore s;
  s.subject = subject;
  s.condition = condition;
  s.repetition = repetition;
  s.score = score;
  return s;
}

// Participants' means 1, 3, 5 / 2, 4, 9 / 3, 8, 10: the table of RepeatedAnova's hand-worked case,
// each mean made of two trials half a unit to either side.
std::vector<TrialScore> small_study() {
  const double means[3][3] = {{5, 3, 1}, {9, 4, 2}, {10, 8, 3}};
  const char* conditions[] = {"haptic", "visual", "visuohaptic"};
  std::vector<TrialScore> scores;
  for (int s = 0; s < 3; ++s) {
    for (int c = 0; c < 3; ++c) {
      scores.push_back(trial("P0" + std::to_string(s + 1), conditions[c], 1, means[s][c] + 0.5));
      scores.push_back(trial("P0" + std::to_string(s + 1), conditions[c], 2, means[s][c] - 0.5));
    }
  }
  return scores;
}

TEST(StudyStatistics, AnalysesPooledTrialsAndParticipantsMeans) {
  const auto study = study_statistics(small_study());
  EXPECT_THAT(study.conditions, ElementsAre("haptic", "visual", "visuohaptic"));
  EXPECT_DOUBLE_EQ(*study.summaries[0].mean, 8.0);
  EXPECT_DOUBLE_EQ(*study.summaries[2].mean, 2.0);
  EXPECT_EQ(study.anova->df_within, 15.0);
  // Between: 6 (9 + 9); within: column squares 14, 14, 2 twice and 18 quarters.
  EXPECT_DOUBLE_EQ(study.anova->squares_between, 108.0);
  EXPECT_DOUBLE_EQ(study.anova->squares_within, 64.5);
  EXPECT_DOUBLE_EQ(study.repeated->f, 18.0);
  EXPECT_NEAR(study.repeated->p, 0.01, 1e-14);
}

TEST(StudyStatistics, TestsTheTwoPlannedComparisons) {
  const auto study = study_statistics(small_study());
  ASSERT_EQ(study.comparisons.size(), 2u);
  EXPECT_EQ(study.comparisons[0].better, "visual");
  EXPECT_EQ(study.comparisons[0].worse, "haptic");
  EXPECT_EQ(study.comparisons[1].better, "visuohaptic");
  for (const auto& c : study.comparisons) {
    EXPECT_LT(c.pooled->t, 0.0);
    EXPECT_EQ(c.pooled->df, 10.0);
    EXPECT_EQ(c.paired->df, 2.0);
    EXPECT_LT(c.paired->p, 0.1);
    EXPECT_GE(*c.paired_holm, c.paired->p);
  }
  const double smaller = std::min(study.comparisons[0].paired->p, study.comparisons[1].paired->p);
  const double adjusted =
      std::min(*study.comparisons[0].paired_holm, *study.comparisons[1].paired_holm);
  EXPECT_DOUBLE_EQ(adjusted, 2.0 * smaller);
}

TEST(StudyStatistics, NamesBestAndWorstOfEachParticipant) {
  auto scores = small_study();
  for (auto& s : scores) {  // P02 ties in two conditions
    s.score = s.subject == "P02" && s.condition == "visual" ? s.score - 2.0 : s.score;
  }
  const auto study = study_statistics(scores);
  ASSERT_EQ(study.table_1.size(), 3u);
  EXPECT_EQ(study.table_1[0].best, "visuohaptic");
  EXPECT_EQ(study.table_1[0].worst, "haptic");
  EXPECT_EQ(study.table_1[1].best, "visual and visuohaptic");
}

TEST(StudyStatistics, LeavesOutWhoLacksACondition) {
  auto scores = small_study();
  scores.push_back(trial("P04", "haptic", 1, 1.0));
  const auto study = study_statistics(scores);
  EXPECT_THAT(study.incomplete, ElementsAre("P04"));
  EXPECT_EQ(study.table_1.size(), 3u);
  EXPECT_DOUBLE_EQ(study.repeated->f, 18.0);
  EXPECT_EQ(study.summaries[0].count, 7u);
}

TEST(StudyStatistics, FollowsLearningOverRepetitions) {
  const auto study = study_statistics(small_study());
  ASSERT_EQ(study.learning.size(), 6u);
  EXPECT_EQ(study.learning[1].repetition, 2);
  EXPECT_DOUBLE_EQ(*study.learning[0].mean - *study.learning[1].mean, 1.0);
  EXPECT_EQ(study.learning[0].participants, 3u);
}

TEST(StudyStatistics, DoesNotDependOnTheOrderOfTrials) {
  RandomStream random(3, "order");
  std::vector<TrialScore> scores;
  for (const char* subject : {"a", "b", "c", "d"}) {
    for (const char* condition : {"haptic", "visual", "visuohaptic"}) {
      scores.push_back(trial(subject, condition, 1, random.uniform()));
    }
  }
  const auto forward = study_statistics(scores);
  std::reverse(scores.begin(), scores.end());
  const auto backward = study_statistics(scores);
  EXPECT_NEAR(forward.anova->f, backward.anova->f, 1e-12);
  EXPECT_NEAR(forward.repeated->f, backward.repeated->f, 1e-12);
  EXPECT_EQ(forward.table_1[0].best, backward.table_1[0].best);
}

TEST(StudyStatistics, OfNothingAndOfOneTrialIsNotDefined) {
  const auto nothing = study_statistics({});
  EXPECT_FALSE(nothing.anova);
  EXPECT_FALSE(nothing.repeated);
  EXPECT_FALSE(nothing.mixed.model);
  EXPECT_TRUE(nothing.comparisons.empty());
  const auto one = study_statistics(std::vector{trial("P01", "haptic", 1, 2.0)});
  EXPECT_THAT(one.anova.because(), HasSubstr("fewer than two groups"));
  EXPECT_FALSE(one.summaries[0].trials);
  EXPECT_EQ(*one.summaries[0].mean, 2.0);
}

}  // namespace
}  // namespace haptrial::analysis
