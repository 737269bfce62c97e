#include "analysis/force_training/study/study_statistics.h"

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
  // The squares between are 6 (9 + 9); within: column squares 14, 14, 2 twice and 18 quarters.
  EXPECT_DOUBLE_EQ(study.anova->squares_between, 108.0);
  EXPECT_DOUBLE_EQ(study.anova->squares_within, 64.5);
  EXPECT_DOUBLE_EQ(study.repeated->f, 18.0);
  EXPECT_NEAR(study.repeated->p, 0.01, 1e-14);
}

/// The shipped study's.
StudyQuestions planned() {
  StudyQuestions questions;
  questions.plan.tests = {{"visual", "haptic", Tail::kLess},
                          {"visuohaptic", "visual", Tail::kLess}};
  return questions;
}

TEST(StudyStatistics, TestsWhatWasPlannedOverParticipantsAndAsPublished) {
  const auto study = study_statistics(small_study(), planned());
  ASSERT_EQ(study.comparisons.size(), 2u);
  EXPECT_EQ(study.comparisons[0].sides.a, "visual");
  EXPECT_EQ(study.comparisons[0].sides.b, "haptic");
  for (const auto& c : study.comparisons) {
    EXPECT_LT(c.student->t, 0.0);
    EXPECT_EQ(c.student->df, 10.0);
  }
  const auto& tests = study.tests.planned.tests;
  ASSERT_EQ(tests.size(), 2u);
  for (const auto& test : tests) {
    EXPECT_TRUE(test.paired);
    EXPECT_EQ(test.count_a, 3u);
    EXPECT_EQ(test.t->df, 2.0);
    EXPECT_LT(test.t->p, 0.1);
    EXPECT_GE(*test.holm, test.t->p);
    EXPECT_FALSE(test.permutation);  // no resampling was asked for
  }
  const double smaller = std::min(tests[0].t->p, tests[1].t->p);
  EXPECT_DOUBLE_EQ(std::min(*tests[0].holm, *tests[1].holm), 2.0 * smaller);
  EXPECT_TRUE(study_statistics(small_study()).tests.planned.tests.empty());
}

TEST(StudyStatistics, APlannedConditionWithoutTrialsIsNotDefined) {
  auto scores = small_study();
  std::erase_if(scores, [](const TrialScore& s) { return s.condition == "visual"; });
  const auto study = study_statistics(scores, planned());
  EXPECT_THAT(study.tests.planned.tests[0].t.because(), HasSubstr("no trials of 'visual'"));
  EXPECT_TRUE(study.comparisons.empty());
}

TEST(StudyStatistics, CountsTheParticipantsOfEachCondition) {
  std::vector<TrialScore> scores;
  for (int i = 0; i < 5; ++i) {
    scores.push_back(trial("A" + std::to_string(i), "haptic", 1, 1.0 + i));
    scores.push_back(trial("A" + std::to_string(i), "haptic", 2, 1.5 + i));
  }
  scores.push_back(trial("B1", "visual", 1, 4.0));
  scores.push_back(trial("B2", "visual", 1, 6.0));
  const auto study = study_statistics(scores);
  EXPECT_EQ(study.summaries[0].people, 5u);
  EXPECT_EQ(study.summaries[0].count, 10u);
  EXPECT_EQ(study.summaries[1].people, 2u);
  EXPECT_EQ(study.summaries[1].count, 2u);
}

TEST(StudyStatistics, TheReferenceConditionComesFirst) {
  StudyQuestions questions;
  questions.plan.reference = "visuohaptic";
  const auto study = study_statistics(small_study(), questions);
  EXPECT_THAT(study.conditions, ElementsAre("visuohaptic", "haptic", "visual"));
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
  EXPECT_THAT(study.tests.incomplete, ElementsAre("P04"));
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
