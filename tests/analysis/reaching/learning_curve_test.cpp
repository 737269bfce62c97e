#include "analysis/reaching/learning_curve.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/base/random.h"
#include "tests/support/null_levels.h"

namespace haptrial::analysis {
namespace {

using ::testing::ElementsAre;

CycleTable table_of(const std::vector<std::vector<double>>& rows) {
  CycleTable table;
  for (std::size_t p = 0; p < rows.size(); ++p) {
    table.participants.push_back(p);
    table.values.emplace_back(rows[p].begin(), rows[p].end());
  }
  return table;
}

TEST(LearningCurveTest, ACycleIsTheMeanOfItsTrials) {
  const std::vector<TrialValue> trials{{7, 0, 1.0}, {7, 1, 3.0}, {7, 2, std::nullopt}, {7, 3, 8.0},
                                       {2, 3, 4.0}, {2, 2, 2.0}, {2, 0, std::nullopt}};
  const CycleTable table = cycle_means(trials, 2);
  EXPECT_THAT(table.participants, ElementsAre(2, 7));
  EXPECT_THAT(table.values[0], ElementsAre(std::nullopt, 3.0));
  EXPECT_THAT(table.values[1], ElementsAre(2.0, 8.0));
  const auto curve = learning_curve(table);
  EXPECT_EQ(curve[0].participants, 1u);
  EXPECT_EQ(curve[0].mean, 2.0);
  EXPECT_EQ(curve[1].mean, 5.5);
  EXPECT_FALSE(curve[0].between);
  EXPECT_FALSE(curve[1].within) << "a value is missing";
  EXPECT_THROW(cycle_means(trials, 0), std::invalid_argument);
}

TEST(LearningCurveTest, TwoCyclesHaveThePairedInterval) {
  // The interval of a difference is √2 times that of its sides.
  const CycleTable table = table_of({{1.0, 2.5}, {5.0, 5.2}, {3.0, 4.4}, {-2.0, 0.1}});
  const auto curve = learning_curve(table);
  const auto paired = paired_t_test(std::vector{1.0, 5.0, 3.0, -2.0},
                                    std::vector{2.5, 5.2, 4.4, 0.1}, Tail::kTwoSided);
  for (const CyclePoint& point : curve) {
    EXPECT_NEAR((point.within->high - point.within->low) * std::sqrt(2.0),
                paired->high - paired->low, 1e-12);
  }
}

TEST(LearningCurveTest, ParticipantsWhoChangeAlikeLeaveNoIntervalWithin) {
  const CycleTable table = table_of({{1.0, 2.0, 4.0}, {11.0, 12.0, 14.0}, {5.0, 6.0, 8.0}});
  for (const CyclePoint& point : learning_curve(table)) {
    EXPECT_FALSE(point.within);
    EXPECT_GT(point.between->high - point.between->low, 10.0);
  }
}

TEST(LearningCurveTest, AContrastIsThePairedTest) {
  const CycleTable table =
      table_of({{1.0, 2.0, 4.0}, {1.0, 3.0, 9.0}, {0.5, 0.0, 2.0}, {1.5, 2.0, 3.0}});
  const auto contrast = cycle_contrast(table, {1, 2}, CycleRange{0, 0}, Tail::kGreater);
  const auto test = paired_t_test(std::vector{3.0, 6.0, 1.0, 2.5}, std::vector{1.0, 1.0, 0.5, 1.5},
                                  Tail::kGreater);
  EXPECT_EQ(contrast->test.p, test->p);
  EXPECT_EQ(contrast->participants, 4u);
  const auto zero = cycle_contrast(table, {0, 0}, std::nullopt, Tail::kLess);
  EXPECT_NEAR(zero->test.difference, 1.0, 1e-15);
  EXPECT_GT(zero->test.p, 0.9);
  CycleTable gap = table;
  gap.values[1][0] = std::nullopt;
  EXPECT_EQ(cycle_contrast(gap, {1, 2}, CycleRange{0, 0}, Tail::kGreater)->left_out, 1u);
  EXPECT_THROW(cycle_contrast(table, {2, 3}, std::nullopt, Tail::kLess), std::invalid_argument);
}

TEST(LearningCurveTest, StudiesWithoutLearningFindItInFivePercent) {
  constexpr std::size_t kStudies = 2000;
  constexpr std::size_t kPeople = 16;
  constexpr std::size_t kTrials = 64;
  std::size_t two_sided = 0, greater = 0, against_zero = 0;
  for (std::size_t study = 0; study < kStudies; ++study) {
    RandomStream random(study, "reaches without learning");
    std::vector<TrialValue> trials;
    for (std::size_t p = 0; p < kPeople; ++p) {
      const double own = 3.0 * random.normal();
      for (std::size_t t = 0; t < kTrials; ++t) {
        const bool lost = random.uniform() < 0.05;
        trials.push_back({p, t, lost ? std::nullopt : std::optional(own + 5.0 * random.normal())});
      }
    }
    const CycleTable table = cycle_means(trials, 8);
    const auto found = [](const Defined<CycleContrast>& contrast) {
      return contrast->test.p < 0.05 ? 1u : 0u;
    };
    two_sided += found(cycle_contrast(table, {4, 4}, CycleRange{3, 3}, Tail::kTwoSided));
    greater += found(cycle_contrast(table, {4, 4}, CycleRange{0, 3}, Tail::kGreater));
    against_zero += found(cycle_contrast(table, {7, 7}, std::nullopt, Tail::kLess));
  }
  RecordProperty("two_sided", static_cast<int>(two_sided));
  RecordProperty("greater", static_cast<int>(greater));
  RecordProperty("against_zero", static_cast<int>(against_zero));
  const test::Band band = test::binomial_band(kStudies, 0.999);
  for (const std::size_t found : {two_sided, greater, against_zero}) {
    EXPECT_GE(found, band.low);
    EXPECT_LE(found, band.high);
  }
}

}  // namespace
}  // namespace haptrial::analysis
