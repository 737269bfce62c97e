#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "analysis/force_training/study/study_mixed.h"
#include "analysis/force_training/study/study_statistics.h"
#include "analysis/statistics/variance/repeated_anova.h"
#include "core/base/random.h"
#include "tests/support/condition_null.h"

namespace haptrial::analysis::study_statistics_test {
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

using testing::IsEmpty;

const std::vector<std::string> kConditions{"haptic", "visual", "visuohaptic"};

struct Design {
  int participants{6};
  int blocks{4};        // of each condition
  int trials{3};        // of a block
  bool between{false};  // each participant has one condition
};

std::vector<TrialScore> design(const Design& d) {
  std::vector<TrialScore> scores;
  for (int p = 0; p < d.participants; ++p) {
    int block = 0;
    for (int c = 0; c < (d.between ? 1 : 3); ++c) {
      for (int b = 0; b < d.blocks; ++b) {
        ++block;
        for (int t = 0; t < d.trials; ++t) {
          TrialScore s;
          s.subject = fmt::format("P{}", 100 + p);
          s.condition = kConditions[static_cast<std::size_t>(d.between ? p % 3 : c)];
          s.block = block;
          scores.push_back(s);
        }
      }
    }
  }
  return scores;
}

/// Variances large enough that none comes out as 0.
std::vector<TrialScore> study(const Design& d, std::uint64_t seed = 1) {
  RandomStream random(seed, "study");
  return test::simulated(design(d), random,
                         {.subject = 4.0, .cell = 2.0, .block = 1.0, .residual = 0.25});
}

std::vector<std::string> notations(const StudyMixed& study) {
  std::vector<std::string> result;
  for (const auto& term : study.terms) {
    result.push_back(term.notation);
  }
  return result;
}

TEST(StudyMixed, FitsTheTermsThatTheDesignHas) {
  const auto whole = study_mixed(study({}), kConditions);
  EXPECT_EQ(whole.formula,
            "score ~ condition + (1 | subject) + (1 | subject:condition) + (1 | subject:block)");
  EXPECT_THAT(whole.left_out, IsEmpty());
  ASSERT_TRUE(whole.model);
  EXPECT_THAT(whole.model->groups, ElementsAre(6, 18, 72));
  EXPECT_EQ(whole.terms[2].words, "block within participant");

  const auto one_block = study_mixed(study({.blocks = 1}), kConditions);
  EXPECT_THAT(notations(one_block), ElementsAre("(1 | subject)", "(1 | subject:condition)"));
  EXPECT_THAT(one_block.left_out,
              ElementsAre("no term for the block within participant: it groups the trials as the "
                          "term for the condition within participant does"));

  const auto single = study_mixed(study({.trials = 1}), kConditions);
  EXPECT_THAT(notations(single), ElementsAre("(1 | subject)", "(1 | subject:condition)"));
  EXPECT_THAT(single.left_out,
              ElementsAre("no term for the block within participant: each has a single trial"));

  const auto means = study_mixed(study({.blocks = 1, .trials = 1}), kConditions);
  EXPECT_THAT(notations(means), ElementsAre("(1 | subject)"));

  const auto between = study_mixed(study({.participants = 12, .between = true}), kConditions);
  EXPECT_THAT(notations(between), ElementsAre("(1 | subject)", "(1 | subject:block)"));
}

// Everybody has the same block numbers, and conditions change within a block.
TEST(StudyMixed, KnowsABlockByItsParticipant) {
  auto scores = design({});
  for (auto& score : scores) {
    score.block = 1 + score.block % 2;
  }
  RandomStream random(2, "mixed blocks");
  scores = test::simulated(scores, random, {.subject = 4.0, .cell = 2.0, .block = 1.0});
  const auto mixed = study_mixed(scores, kConditions);
  ASSERT_TRUE(mixed.model) << mixed.model.because();
  EXPECT_THAT(mixed.model->groups, ElementsAre(6, 18, 12));
}

TEST(StudyMixed, OfABalancedStudyIsTheRepeatedMeasuresAnova) {
  const auto scores = study({.participants = 12});
  const auto mixed = study_mixed(scores, kConditions);
  const auto repeated = repeated_measures_anova(test::means_table(scores));
  ASSERT_TRUE(mixed.model && mixed.omnibus && repeated);
  ASSERT_FALSE(mixed.model->at_boundary);
  EXPECT_NEAR(mixed.omnibus->f / repeated->f, 1.0, 1e-9);
  EXPECT_NEAR(mixed.omnibus->df_denominator, repeated->df_error, 1e-7);
  EXPECT_NEAR(mixed.omnibus->p, repeated->p, 1e-9);
}

TEST(StudyMixed, ComparesEveryTwoConditionsWhateverTheReference) {
  auto scores = study({.participants = 8});
  scores.erase(scores.begin() + 3, scores.begin() + 15);  // unbalanced; of P100 all haptic ones
  std::erase_if(scores,
                [](const auto& s) { return s.subject == "P103" && s.condition == "visual"; });
  const auto first = study_mixed(scores, kConditions);
  const auto last = study_mixed(scores, kConditions, "visuohaptic");
  ASSERT_TRUE(first.model && last.model);
  EXPECT_THAT(last.conditions, ElementsAre("visuohaptic", "haptic", "visual"));
  ASSERT_EQ(first.pairs.size(), 3u);
  const MixedPair& a = first.pairs[1];  // haptic - visuohaptic
  const MixedPair& b = last.pairs[0];   // visuohaptic - haptic
  EXPECT_EQ(a.b, b.a);
  EXPECT_NEAR(a.difference->estimate, -b.difference->estimate, 1e-9);
  EXPECT_NEAR(a.difference->df, b.difference->df, 1e-6);
  EXPECT_NEAR(a.difference->p, b.difference->p, 1e-9);
  EXPECT_NEAR(*a.holm, *b.holm, 1e-9);
  EXPECT_GE(*a.holm, a.difference->p);
  // The other coefficients are differences from the reference.
  EXPECT_NEAR(last.model->coefficients[1].estimate, -b.difference->estimate, 1e-12);
  EXPECT_NEAR(first.omnibus->f / last.omnibus->f, 1.0, 1e-8);
  EXPECT_EQ(first.omnibus->df_numerator, 2.0);
}

TEST(StudyMixed, SaysWhyItIsNotDefined) {
  EXPECT_EQ(study_mixed({}, kConditions).model.because(), "there are no trials");
  const auto scores = study({});
  EXPECT_EQ(
      study_mixed(test::Scores(scores.begin(), scores.begin() + 12), {"haptic"}).omnibus.because(),
      "there are fewer than two conditions");
  EXPECT_EQ(study_mixed(scores, {"haptic", "visual", "visuohaptic", "none"}).model.because(),
            "the condition none has no trials");
  EXPECT_EQ(
      study_mixed(study({.blocks = 1, .trials = 1, .between = true}), kConditions).model.because(),
      "each participant has a single trial");
  // One participant in each condition: whose is the difference?
  EXPECT_THAT(study_mixed(study({.participants = 3, .between = true}), kConditions).model.because(),
              HasSubstr("groups and predictors go together"));
  EXPECT_THROW(study_mixed(scores, {"haptic", "visual"}), std::invalid_argument);
  EXPECT_THROW(study_mixed(scores, kConditions, "none"), std::invalid_argument);
}

// More than 18 of 100 below 0.05: one in 2 million runs of an exact test.
TEST(StudyMixed, KeepsItsLevelWhereARandomInterceptAloneDoesNot) {
  constexpr int kStudies = 100;
  constexpr int kMost = 18;
  RandomStream random(1, "level");
  const auto scores = test::simulated(design({.participants = 12, .blocks = 8}), random);
  for (const auto scheme :
       {test::NullScheme::kBlocks, test::NullScheme::kParticipants, test::NullScheme::kSimulated}) {
    SCOPED_TRACE(static_cast<int>(scheme));
    const auto studies = test::null_studies(scores, scheme, kStudies, 1);
    const auto below = [&](auto&& p) { return test::count_below(studies, p); };
    EXPECT_LE(below([](const auto& s) { return s.mixed; }), kMost);
    EXPECT_LE(below([](const auto& s) { return s.differences[0]; }), kMost);
    EXPECT_LE(below([](const auto& s) { return s.differences[1]; }), kMost);
    EXPECT_LE(below([](const auto& s) { return s.repeated; }), kMost);
    EXPECT_GT(below([](const auto& s) { return s.intercept; }), kMost);
    EXPECT_GT(below([](const auto& s) { return s.pooled; }), kMost);
  }
}

}  // namespace
}  // namespace haptrial::analysis::study_statistics_test
