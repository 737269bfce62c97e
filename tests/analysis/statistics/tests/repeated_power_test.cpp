#include "analysis/statistics/tests/repeated_power.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/base/random.h"
#include "tests/support/two_factors.h"

namespace haptrial::analysis {
namespace {

using testing::HasSubstr;

RepeatedPlan plan_of(RepeatedTerm term, int groups = 2, int measurements = 3) {
  RepeatedPlan plan;
  plan.term = term;
  plan.groups = groups;
  plan.measurements = measurements;
  return plan;
}

TEST(RepeatedPower, OfTwoMeasurementsIsThatOfThePairedT) {
  // Means differ by 2 f; differences have the variance 2 (1 - rho).
  for (const double f : {0.1, 0.3, 0.6}) {
    const RepeatedPlan plan = plan_of(RepeatedTerm::kWithin, 1, 2);
    EXPECT_NEAR(*repeated_power(plan, 12.0, f),
                *t_power({TDesign::kPaired, 0.05, false}, 12.0, 2.0 * f), 1e-12);
  }
}

TEST(RepeatedPower, BetweenGroupsIsThatOfTheGroupsMeans) {
  // The mean of m values has the variance (1 + (m - 1) rho) / m.
  RepeatedPlan plan = plan_of(RepeatedTerm::kBetween, 3, 4);
  plan.correlation = 0.7;
  const double f = 0.3 / std::sqrt((1.0 + 3.0 * 0.7) / 4.0);
  EXPECT_NEAR(*repeated_power(plan, 9.0, 0.3), *anova_power({3, 0.05}, 9.0, f), 1e-12);
}

TEST(RepeatedPower, IsTheShareOfMixedAnalysesThatReject) {
  // Two groups of 8, three measurements with the correlation 0.5, deviations of each term.
  constexpr int kStudies = 3000;
  RandomStream random(2007, "repeated power");
  int within = 0, interaction = 0, between = 0;
  for (int study = 0; study < kStudies; ++study) {
    std::vector<std::vector<std::vector<double>>> groups(2);
    for (int g = 0; g < 2; ++g) {
      const double side = g == 0 ? -1.0 : 1.0;
      for (int p = 0; p < 8; ++p) {
        const double person = std::sqrt(0.5) * random.normal() + 0.4 * side;
        std::vector<double> row;
        for (const double place : {-1.0, 0.0, 1.0}) {
          row.push_back(person + (0.3 + 0.35 * side) * place + std::sqrt(0.5) * random.normal());
        }
        groups[static_cast<std::size_t>(g)].push_back(row);
      }
    }
    const auto found = test::mixed_factors(groups);
    between += found.a->p < 0.05 ? 1 : 0;
    within += found.b->p < 0.05 ? 1 : 0;
    interaction += found.interaction->p < 0.05 ? 1 : 0;
  }
  const double three = std::sqrt(2.0 / 3.0);  // of -1, 0, 1
  const auto near = [&](int count, RepeatedTerm term, double f) {
    EXPECT_NEAR(static_cast<double>(count) / kStudies, *repeated_power(plan_of(term), 8.0, f),
                4.0 * std::sqrt(0.25 / kStudies));
  };
  near(within, RepeatedTerm::kWithin, 0.3 * three);
  near(interaction, RepeatedTerm::kInteraction, 0.35 * three);
  near(between, RepeatedTerm::kBetween, 0.4);
}

TEST(RepeatedPower, WithoutAnEffectIsAlphaAndALowerEpsilonFindsLess) {
  RepeatedPlan plan = plan_of(RepeatedTerm::kInteraction, 2, 4);
  EXPECT_NEAR(*repeated_power(plan, 9.0, 0.0), 0.05, 1e-13);
  const double sphere = *repeated_power(plan, 9.0, 0.25);
  plan.epsilon = 0.5;
  EXPECT_LT(*repeated_power(plan, 9.0, 0.25), sphere - 0.1);
}

TEST(RepeatedPower, SolvesForSizeAndEffect) {
  const RepeatedPlan plan = plan_of(RepeatedTerm::kWithin);
  const auto size = repeated_sample_size(plan, 0.25, 0.9);
  ASSERT_TRUE(size);
  EXPECT_LT(*repeated_power(plan, static_cast<double>(size->n - 1), 0.25), 0.9);
  EXPECT_GE(*repeated_power(plan, static_cast<double>(size->n), 0.25), 0.9);
  EXPECT_NEAR(*repeated_detectable(plan, size->exact, 0.9), 0.25, 1e-9);
}

TEST(RepeatedPower, IsNotDefinedOutsideItsRanges) {
  RepeatedPlan plan = plan_of(RepeatedTerm::kInteraction, 1);
  EXPECT_THAT(repeated_power(plan, 9.0, 0.2).because(), HasSubstr("between 2 and 1000"));
  plan.groups = 2;
  plan.correlation = 1.0;
  EXPECT_THAT(repeated_power(plan, 9.0, 0.2).because(), HasSubstr("correlation"));
  plan.correlation = 0.5;
  plan.epsilon = 0.4;
  EXPECT_THAT(repeated_detectable(plan, 9.0, 0.8).because(), HasSubstr("epsilon"));
  plan.epsilon = 0.5;
  EXPECT_THAT(repeated_sample_size(plan, 0.0, 0.8).because(), HasSubstr("no effect"));
  EXPECT_THAT(repeated_sample_size(plan, 0.2, 0.01).because(), HasSubstr("alpha"));
}

}  // namespace
}  // namespace haptrial::analysis
