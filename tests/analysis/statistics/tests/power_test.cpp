#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "analysis/statistics/tests/power.h"
#include "analysis/statistics/tests/t_tests.h"
#include "analysis/statistics/variance/anova.h"
#include "core/base/random.h"
#include "tests/analysis/statistics/normal_values.h"
#include "tests/support/two_factors.h"

namespace haptrial::analysis {
namespace {

using test::normal_values;
using testing::HasSubstr;
using Values = std::vector<double>;

TEST(Power, WithoutAnEffectIsAlpha) {
  for (const auto design : {TDesign::kOneSample, TDesign::kTwoSample, TDesign::kPaired}) {
    for (const bool one_tailed : {false, true}) {
      EXPECT_NEAR(*t_power({design, 0.01, one_tailed}, 9.0, 0.0), 0.01, 1e-14);
    }
  }
  EXPECT_NEAR(*anova_power({4, 0.05}, 9.0, 0.0), 0.05, 1e-14);
}

TEST(Power, IsTheShareOfTestsThatReject) {
  RandomStream random(2006, "power");
  constexpr int kStudies = 3000;
  int t_tests = 0, pairs = 0, anovas = 0;
  for (int i = 0; i < kStudies; ++i) {
    const Values a = normal_values(random, 10, 1.0), b = normal_values(random, 10, 0.0);
    t_tests += student_t_test(a, b, Tail::kTwoSided)->p < 0.05 ? 1 : 0;
    // Differences of two values have the variance 2.
    pairs += paired_t_test(a, b, Tail::kGreater)->p < 0.05 ? 1 : 0;
    // Means 1, 0, 0: standard deviation sqrt(2) / 3.
    anovas += one_way_anova({a, b, normal_values(random, 10, 0.0)})->p < 0.05 ? 1 : 0;
  }
  const auto near = [&](int count, double power) {
    EXPECT_NEAR(static_cast<double>(count) / kStudies, power, 4.0 * std::sqrt(0.25 / kStudies));
  };
  near(t_tests, *t_power({TDesign::kTwoSample, 0.05, false}, 10.0, 1.0));
  near(pairs, *t_power({TDesign::kPaired, 0.05, true}, 10.0, std::sqrt(0.5)));
  near(anovas, *anova_power({3, 0.05}, 10.0, std::sqrt(2.0) / 3.0));
}

TEST(Power, OfTwoGroupsIsThatOfTheTwoSidedT) {
  for (const double d : {0.1, 0.8, 2.0}) {
    EXPECT_NEAR(*anova_power({2, 0.05}, 12.0, 0.5 * d),
                *t_power({TDesign::kTwoSample, 0.05, false}, 12.0, d), 1e-13);
  }
}

TEST(Power, OfUnequalGroupsIsThatOfR) {
  // 4 and 20 people, d = 0.9: pt() of R at 22 degrees of freedom and ncp 0.9 / sqrt(1/4 + 1/20).
  TPlan plan{TDesign::kTwoSample, 0.05, false, 5.0};
  EXPECT_NEAR(*t_power(plan, 4.0, 0.9), 0.3490821112, 1e-9);
  plan.one_tailed = true;
  EXPECT_NEAR(*t_power(plan, 4.0, 0.9), 0.4790814421, 1e-9);
}

TEST(SampleSize, IsTheFirstThatSuffices) {
  const TPlan plan{TDesign::kTwoSample, 0.05, false};
  const auto size = t_sample_size(plan, 0.5, 0.8);
  ASSERT_TRUE(size);
  EXPECT_EQ(size->n, 64);  // Cohen 1988, table 2.4.1
  EXPECT_GE(size->power, 0.8);
  EXPECT_LT(*t_power(plan, 63.0, 0.5), 0.8);
  EXPECT_NEAR(*t_power(plan, size->exact, 0.5), 0.8, 1e-13);
  const auto groups = anova_sample_size({3, 0.05}, 0.25, 0.8);
  EXPECT_EQ(groups->n, 53);
  EXPECT_LT(*anova_power({3, 0.05}, 52.0, 0.25), 0.8);
  EXPECT_EQ(t_sample_size(plan, -0.5, 0.8)->n, 64) << "a two-sided test looks both ways";
  EXPECT_EQ(t_sample_size(plan, 60.0, 0.8)->n, 2);
}

TEST(Detectable, GivesBackTheEffect) {
  const TPlan plan{TDesign::kPaired, 0.05, true};
  EXPECT_NEAR(*t_detectable(plan, 12.0, *t_power(plan, 12.0, 0.77)), 0.77, 1e-12);
  EXPECT_NEAR(*anova_detectable({4, 0.01}, 20.0, *anova_power({4, 0.01}, 20.0, 0.31)), 0.31, 1e-12);
}

TEST(Power, RisesWithSizeAndEffectUpToItsEnds) {
  const TPlan plan;
  double previous = 0.0;
  for (const double n : {2.0, 3.0, 10.0, 100.0, 1e4, 1e7}) {
    const double power = *t_power(plan, n, 0.3);
    EXPECT_GE(power, previous);
    EXPECT_LE(power, 1.0);
    previous = power;
  }
  EXPECT_NEAR(*t_power(plan, 1e7, 100.0), 1.0, 1e-11);
  EXPECT_NEAR(*anova_power({3, 0.05}, 1e7, 100.0), 1.0, 1e-11);
}

TEST(Power, SaysWhyItIsNotDefined) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const TPlan plan;
  EXPECT_THAT(t_power(plan, 1.0, 0.5).because(), HasSubstr("participants"));
  EXPECT_THAT(t_power(plan, nan, 0.5).because(), HasSubstr("participants"));
  EXPECT_THAT(t_power(plan, 9.0, nan).because(), HasSubstr("effect"));
  EXPECT_THAT(t_power({TDesign::kPaired, 0.0, false}, 9.0, 0.5).because(), HasSubstr("alpha"));
  EXPECT_THAT(t_sample_size(plan, 0.0, 0.8).because(), HasSubstr("no effect"));
  EXPECT_THAT(t_sample_size({TDesign::kPaired, 0.05, true}, -0.5, 0.8).because(),
              HasSubstr("no effect"));
  EXPECT_THAT(t_sample_size(plan, 0.5, 0.04).because(), HasSubstr("between alpha and 1"));
  EXPECT_THAT(t_sample_size(plan, 0.5, 1.0).because(), HasSubstr("between alpha and 1"));
  EXPECT_THAT(t_sample_size(plan, 1e-5, 0.8).because(), HasSubstr("ten million"));
  EXPECT_THAT(anova_sample_size({3, 0.05}, 1e-5, 0.8).because(), HasSubstr("ten million"));
  EXPECT_THAT(anova_power({1, 0.05}, 9.0, 0.5).because(), HasSubstr("two groups"));
  EXPECT_THAT(anova_power({3, 0.05}, 9.0, -0.5).because(), HasSubstr("below 0"));
  EXPECT_THAT(anova_sample_size({3, 0.05}, 0.0, 0.8).because(), HasSubstr("no effect"));
  EXPECT_THAT(t_detectable(plan, 9.0, 0.01).because(), HasSubstr("between alpha and 1"));
  EXPECT_THAT(anova_detectable({3, 0.05}, 1.0, 0.8).because(), HasSubstr("participants"));
}

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
