// Analyses of covariance beside R's lm() and aov(), and their level without a difference.
#include "analysis/statistics/design/covariate_tests.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <vector>

#include "analysis/statistics/design/design_tests.h"
#include "core/base/random.h"
#include "tests/support/null_levels.h"

namespace haptrial::analysis::covariate_test {
namespace {

using Values = std::vector<double>;

const Values kX{2.1, 3.4, 1.2, 5.0, 4.1, 2.8, 3.9, 0.7, 4.6, 1.9};
const Values kFirst{5.2, 6.1, 4.0, 8.3, 7.4, 5.1, 7.7, 3.1, 7.9, 4.4};
const Values kSecond{4.1, 5.9, 3.9, 6.2, 6.6, 4.2, 6.1, 3.3, 6.4, 3.3};
const Values kThird{4.9, 6.3, 3.2, 8.9, 6.1, 5.7, 7.0, 2.2, 8.4, 5.2};

std::string person(std::size_t i) { return fmt::format("P{:02}", i); }

AnalysisPlan planned(const std::string& test) {
  AnalysisPlan plan = parse_analysis_plan({test}, "", "tests");
  plan.covariate.name = "age";
  for (std::size_t i = 0; i < kX.size(); ++i) {
    plan.covariate.values[person(i)] = kX[i];
  }
  return plan;
}

DesignTests within(const std::vector<Values>& values, const std::string& test) {
  std::vector<Observation> all;
  for (std::size_t k = 0; k < values.size(); ++k) {
    for (std::size_t i = 0; i < kX.size(); ++i) {
      all.push_back({person(i), {fmt::format("c{}", k + 1)}, values[k][i]});
    }
  }
  all.push_back({"without age", {"c1"}, 3.0});
  all.push_back({"without age", {"c2"}, 30.0});
  return design_tests(design_table(all, {"condition"}), planned(test), {1, "", 0, 1});
}

TEST(CovariateTests, ThePlannedTestOfTheSamePeopleIsNotAdjusted) {
  const DesignTests tests = within({kFirst, kSecond}, "c1 != c2");
  const SideTest& test = tests.planned.tests.front();
  EXPECT_TRUE(test.t);
  EXPECT_THAT(test.adjusted.because(), testing::HasSubstr("the same people are compared"));
}

TEST(CovariateTests, WhetherDifferencesOfPairsFollowIsTheSlopeOfLm) {
  const auto effect = within({kFirst, kSecond}, "c1 != c2").effects.back();
  ASSERT_TRUE(effect) << effect.because();
  EXPECT_EQ(effect->factor, "condition × age");
  EXPECT_NEAR(effect->f, std::pow(3.224441585207, 2), 1e-8);
  EXPECT_NEAR(effect->p, 0.0121579109999, 1e-10);
  EXPECT_EQ(effect->df_error, 8.0);
}

TEST(CovariateTests, ThreeConditionsHaveTheErrorStrataOfAov) {
  const auto effect = within({kFirst, kSecond, kThird}, "c1 != c2").effects.back();
  ASSERT_TRUE(effect) << effect.because();
  EXPECT_NEAR(effect->f, 4.03095, 1e-5);
  EXPECT_EQ(effect->df_effect, 2.0);
  EXPECT_EQ(effect->df_error, 16.0);
  EXPECT_NEAR(effect->p, 0.0382226, 1e-7);
}

DesignTests between(const std::vector<std::size_t>& groups, const std::string& test) {
  std::vector<Observation> all;
  for (std::size_t i = 0; i < kX.size(); ++i) {
    all.push_back({person(i), {fmt::format("g{}", groups[i])}, kFirst[i]});
  }
  return design_tests(design_table(all, {"group"}), planned(test), {1, "", 0, 1});
}

TEST(CovariateTests, DifferencesOfGroupsAreThoseOfLm) {
  const DesignTests tests = between({1, 1, 1, 1, 1, 2, 2, 2, 2, 2}, "g1 > g2");
  const SideTest& test = tests.planned.tests.front();
  ASSERT_TRUE(test.adjusted) << test.adjusted.because();
  EXPECT_NEAR(test.adjusted->difference, 0.0965443037975, 1e-10);
  EXPECT_NEAR(test.adjusted->t, 0.376449465378, 1e-9);
  EXPECT_NEAR(test.adjusted->p, 0.5 * 0.717733668523, 1e-9);
}

TEST(CovariateTests, ThreeGroupsHaveTheFOfDrop1) {
  const auto effect = between({1, 1, 1, 2, 2, 2, 2, 3, 3, 3}, "g1 != g2").effects.back();
  ASSERT_TRUE(effect) << effect.because();
  EXPECT_NEAR(effect->f, 0.11882, 1e-5);
  EXPECT_EQ(effect->df_error, 6.0);
}

/// Studies in which the covariate matters to the values and not to their differences, and the
/// conditions do not.
DesignTests null_study(std::size_t number, bool is_within) {
  RandomStream random(1, fmt::format("covariate {} {}", number, is_within));
  AnalysisPlan plan = parse_analysis_plan({"a != b"}, "", "tests");
  plan.covariate.name = "age";
  std::vector<Observation> all;
  for (std::size_t i = 0; i < 12; ++i) {
    const double x = random.normal(), own = random.normal();
    plan.covariate.values[person(i)] = x;
    for (const char* level : {"a", "b", "c"}) {
      if (is_within || level[0] == "abc"[i % 3]) {
        all.push_back({person(i), {level}, 2.0 * x + own + random.normal()});
      }
    }
  }
  return design_tests(design_table(all, {"factor"}), plan, {1, "", 0, 1});
}

TEST(CovariateTests, KeepTheirLevelInNullStudies) {
  const std::size_t studies = test::null_studies(200);
  const auto levels = test::null_levels(studies, 2, [](std::size_t number) {
    test::NullLevels noted;
    for (const bool is_within : {true, false}) {
      const DesignTests tests = null_study(number, is_within);
      const char* what = is_within ? " within" : " between";
      noted.note(std::string("effect") + what, true, tests.effects.back()->p <= 0.05);
      if (const auto& adjusted = tests.planned.tests.front().adjusted) {
        noted.note(std::string("planned") + what, true, adjusted->p <= 0.05);
      }
    }
    return noted;
  });
  const auto band = test::binomial_band(studies, 1.0 - 1e-6);
  for (const auto& level : levels) {
    std::printf("%s: %zu of %zu\n", level.test.c_str(), level.found, studies);
    EXPECT_GE(level.found, band.low) << level.test;
    EXPECT_LE(level.found, band.high) << level.test;
  }
}

TEST(CovariateTests, SeveralFactorsHaveNoEffect) {
  const std::vector<Observation> all{{"P00", {"a", "x"}, 1.0},
                                     {"P00", {"b", "x"}, 2.0},
                                     {"P01", {"a", "y"}, 1.5},
                                     {"P01", {"b", "y"}, 2.5}};
  Covariate age{"age", {{"P00", 1.0}, {"P01", 2.0}}};
  EXPECT_THAT(adjusted_effect(design_table(all, {"one", "two"}), age).because(),
              testing::HasSubstr("for one factor"));
}

TEST(CovariateTests, WithoutValuesNothingIsAdjusted) {
  AnalysisPlan plan = parse_analysis_plan({"a != b"}, "", "tests");
  plan.covariate.name = "age";
  const DesignTable table = design_table(
      std::vector<Observation>{
          {"P00", {"a"}, 1.0}, {"P00", {"b"}, 2.0}, {"P01", {"a"}, 1.5}, {"P01", {"b"}, 2.7}},
      {"one"});
  const DesignTests tests = design_tests(table, plan, {1, "", 0, 1});
  EXPECT_THAT(tests.effects.back().because(), testing::HasSubstr("nobody"));
}

}  // namespace
}  // namespace haptrial::analysis::covariate_test
