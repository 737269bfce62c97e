#include "analysis/statistics/variance/effect_size.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "analysis/statistics/tests/t_tests.h"
#include "analysis/statistics/variance/repeated_anova.h"
#include "core/base/random.h"
#include "tests/analysis/statistics/normal_values.h"

namespace haptrial::analysis::effect_size_test {
namespace {

using test::normal_values;
using testing::HasSubstr;
using Values = std::vector<double>;
using Table = std::vector<Values>;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(CohensD, MatchesACaseWorkedByHand) {
  // Means 2 and 6, pooled variance (2 + 8) / 4.
  const auto d = cohens_d(Values{1, 2, 3}, Values{4, 6, 8});
  ASSERT_TRUE(d);
  EXPECT_NEAR(d->value, -4.0 / std::sqrt(2.5), 1e-14);
  EXPECT_LT(d->low, d->value);
  EXPECT_GT(d->high, d->value);
  EXPECT_EQ(d->level, 0.95);
}

TEST(CohensD, IntervalCoversTheTruthAsOftenAsItSays) {
  RandomStream random(2006, "coverage of d");
  constexpr int kStudies = 1000;
  int covered = 0;
  for (int i = 0; i < kStudies; ++i) {
    const auto d = cohens_d(normal_values(random, 8, 0.8), normal_values(random, 5, 0.0));
    covered += d->low < 0.8 && 0.8 < d->high ? 1 : 0;
  }
  // Four standard errors of a share of 0.95.
  EXPECT_NEAR(covered / static_cast<double>(kStudies), 0.95, 0.028);
}

TEST(CohensD, IntervalLeavesOutZeroExactlyWhenTheTestRejects) {
  RandomStream random(3, "d and t");
  for (int i = 0; i < 60; ++i) {
    const Values a = normal_values(random, 9, 0.9);
    const Values b = normal_values(random, 7, 0.0);
    const auto d = cohens_d(a, b);
    EXPECT_EQ(d->low > 0.0 || d->high < 0.0, student_t_test(a, b, Tail::kTwoSided)->p < 0.05);
  }
}

TEST(CohensDz, MatchesACaseWorkedByHand) {
  // Differences 1, 2, 3: mean 2, standard deviation 1.
  EXPECT_NEAR(cohens_dz(Values{2, 4, 7}, Values{1, 2, 4})->value, 2.0, 1e-15);
}

TEST(HedgesG, RemovesTheBias) {
  EXPECT_NEAR(hedges_correction(2.0), 1.0 / std::sqrt(std::numbers::pi), 1e-15);
  EXPECT_NEAR(hedges_correction(3.0), std::sqrt(std::numbers::pi / 6.0), 1e-15);
  EXPECT_NEAR(hedges_correction(1e7), 1.0 - 0.75e-7, 1e-14);
  RandomStream random(4, "bias of g");
  constexpr int kStudies = 4000;
  double d = 0.0;
  double g = 0.0;
  for (int i = 0; i < kStudies; ++i) {
    const Values a = normal_values(random, 4, 1.0);
    const Values b = normal_values(random, 4, 0.0);
    d += student_t_test(a, b, Tail::kTwoSided)->t * std::sqrt(0.5) / kStudies;
    g += student_t_test(a, b, Tail::kTwoSided)->t * std::sqrt(0.5) * hedges_correction(6.0) /
         kStudies;
  }
  EXPECT_NEAR(g, 1.0, 0.06);  // four standard errors
  EXPECT_GT(d, 1.08);         // by 15 %, the bias of six degrees of freedom
  const auto both = hedges_g(Values{1, 2, 3}, Values{4, 6, 8});
  EXPECT_EQ(both->low, cohens_d(Values{1, 2, 3}, Values{4, 6, 8})->low);
}

TEST(ProportionOfVariance, OfTwoGroupsFollowsFromD) {
  const Values a{1.5, 2, 3.5, 2.2};
  const Values b{4, 6, 8};
  const auto anova = one_way_anova({a, b});
  const double d = cohens_d(a, b)->value;
  const double scaled = d * d / (1.0 / 4.0 + 1.0 / 3.0);  // t²
  EXPECT_NEAR(eta_squared(*anova)->value, scaled / (scaled + 5.0), 1e-14);
  EXPECT_NEAR(eta_squared(*anova)->value, anova->eta_squared, 1e-14);
}

TEST(ProportionOfVariance, IntervalLeavesOutZeroExactlyWhenTheTestRejects) {
  RandomStream random(5, "eta and F");
  for (int i = 0; i < 60; ++i) {
    const auto anova = one_way_anova({normal_values(random, 6, 0.0), normal_values(random, 6, 0.4),
                                      normal_values(random, 9, 1.0)});
    const auto eta = eta_squared(*anova);
    EXPECT_EQ(eta->low > 0.0, anova->p < 0.05);
    EXPECT_LE(eta->low, eta->value);
    EXPECT_LT(eta->high, 1.0);
  }
}

TEST(GeneralizedEta, CountsParticipantsToo) {
  // Squares 54 of the condition, 24 of participants, 6 of error.
  const auto a = repeated_measures_anova({{1, 3, 5}, {2, 4, 9}, {3, 8, 10}});
  EXPECT_NEAR(
      *generalized_eta_squared(a->squares_condition, a->squares_participants + a->squares_error),
      54.0 / 84.0, 1e-14);
  EXPECT_NEAR(*generalized_eta_squared(10.0, 40.0, false), 0.25, 1e-16);
}

TEST(EffectSize, SaysWhyItIsNotDefined) {
  EXPECT_THAT(cohens_d(Values{}, Values{1, 2}).because(), HasSubstr("no values"));
  EXPECT_THAT(cohens_d(Values{1, kNan}, Values{1, 2}).because(), HasSubstr("finite"));
  EXPECT_THAT(cohens_d(Values{1, 1}, Values{2, 2}).because(), HasSubstr("vary"));
  EXPECT_THAT(cohens_d(Values{1, 1 + 1e-9}, Values{9, 9}).because(), HasSubstr("too large"));
  EXPECT_THAT(cohens_dz(Values{1}, Values{2}).because(), HasSubstr("two pairs"));
  EXPECT_THROW(cohens_dz(Values{1, 2}, Values{1}), std::invalid_argument);
  EXPECT_THAT(hedges_g(Values{1, 2}, Values{4}).because(), HasSubstr("too few"));
  EXPECT_THAT(partial_eta_squared(kNan, 2, 9).because(), HasSubstr("no F"));
  EXPECT_THAT(partial_eta_squared(1e12, 2, 9).because(), HasSubstr("too large"));
  EXPECT_THAT(generalized_eta_squared(0.0, 0.0).because(), HasSubstr("no squares"));
}

}  // namespace
}  // namespace haptrial::analysis::effect_size_test
