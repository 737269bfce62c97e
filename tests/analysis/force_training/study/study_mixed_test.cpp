#include "analysis/force_training/study/study_mixed.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "analysis/statistics/variance/repeated_anova.h"
#include "tests/support/condition_null.h"

namespace haptrial::analysis::study_mixed_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
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

// The same block numbers for everybody, and conditions that change within a block.
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
}  // namespace haptrial::analysis::study_mixed_test
