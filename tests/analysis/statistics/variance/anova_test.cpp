#include "analysis/statistics/variance/anova.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "analysis/statistics/tests/t_tests.h"
#include "analysis/statistics/variance/repeated_anova.h"
#include "core/base/random.h"

namespace haptrial::analysis::anova_test {
namespace {

using testing::HasSubstr;
using Table = std::vector<std::vector<double>>;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// With two degrees of freedom above, the tail of F has a closed form.
double f_tail_of_two(double f, double df) { return std::pow(1.0 + 2.0 * f / df, -df / 2.0); }

Table random_table(RandomStream& random, std::size_t rows, std::size_t columns) {
  Table table(rows, std::vector<double>(columns));
  for (auto& row : table) {
    for (auto& value : row) {
      value = random.normal();
    }
  }
  return table;
}

Table mapped(Table table, double factor, double shift) {
  for (auto& row : table) {
    for (auto& value : row) {
      value = value * factor + shift;
    }
  }
  return table;
}

TEST(OneWayAnova, MatchesACaseWorkedByHand) {
  // Means 5, 9, 10; grand mean 8; squares 84 between and 68 within.
  const auto a = one_way_anova({{6, 8, 4, 5, 3, 4}, {8, 12, 9, 11, 6, 8}, {13, 9, 11, 8, 7, 12}});
  ASSERT_TRUE(a);
  EXPECT_DOUBLE_EQ(a->squares_between, 84.0);
  EXPECT_DOUBLE_EQ(a->squares_within, 68.0);
  EXPECT_DOUBLE_EQ(a->f, 42.0 / (68.0 / 15.0));
  EXPECT_DOUBLE_EQ(a->eta_squared, 84.0 / 152.0);
  EXPECT_NEAR(a->p, f_tail_of_two(a->f, 15.0), 1e-15);
}

TEST(OneWayAnova, TakesGroupsOfDifferentSizes) {
  // Means 2 and 5, grand mean 16/5: between 3 (6/5)² + 2 (9/5)² = 54/5, within 2 + 2.
  const auto a = one_way_anova({{1, 2, 3}, {4, 6}});
  ASSERT_TRUE(a);
  EXPECT_DOUBLE_EQ(a->squares_between, 10.8);
  EXPECT_DOUBLE_EQ(a->squares_within, 4.0);
  EXPECT_DOUBLE_EQ(a->df_within, 3.0);
}

TEST(OneWayAnova, OfTwoGroupsIsTheSquareOfStudentsT) {
  RandomStream random(11, "two groups");
  for (int i = 0; i < 50; ++i) {
    Table groups = random_table(random, 2, 7);
    groups[1].resize(4);
    const auto a = one_way_anova(groups);
    const auto t = student_t_test(groups[0], groups[1], Tail::kTwoSided);
    ASSERT_TRUE(a && t);
    EXPECT_NEAR(a->f, t->t * t->t, 1e-12 * (1.0 + a->f));
    EXPECT_NEAR(a->p, t->p, 1e-12);
  }
}

TEST(OneWayAnova, IgnoresShiftAndScale) {
  RandomStream random(12, "shift and scale");
  const Table groups = random_table(random, 4, 9);
  const auto plain = one_way_anova(groups);
  for (const auto& [factor, shift] : {std::pair{1.0, 1e6}, {-3.5, 0.0}, {1e-9, 4e-6}}) {
    const auto moved = one_way_anova(mapped(groups, factor, shift));
    ASSERT_TRUE(moved);
    EXPECT_NEAR(moved->f, plain->f, 1e-8 * plain->f);
    EXPECT_NEAR(moved->p, plain->p, 1e-8);
  }
}

TEST(OneWayAnova, SaysWhyItIsNotDefined) {
  EXPECT_THAT(one_way_anova({{1, 2}}).because(), HasSubstr("fewer than two groups"));
  EXPECT_THAT(one_way_anova({{1, 2}, {}}).because(), HasSubstr("empty"));
  EXPECT_THAT(one_way_anova({{1}, {2}}).because(), HasSubstr("single value"));
  EXPECT_THAT(one_way_anova({{0.1, 0.1, 0.1}, {0.7, 0.7, 0.7}}).because(), HasSubstr("not vary"));
  EXPECT_THAT(one_way_anova({{1, kNan}, {2, 3}}).because(), HasSubstr("finite"));
}

// The largest distance between the p values and the uniform distribution, times sqrt(n):
// 1.95 is exceeded once in a thousand.
double kolmogorov_smirnov(std::vector<double> p) {
  std::sort(p.begin(), p.end());
  const auto n = static_cast<double>(p.size());
  double distance = 0.0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const auto rank = static_cast<double>(i);
    distance = std::max({distance, p[i] - rank / n, (rank + 1.0) / n - p[i]});
  }
  return distance * std::sqrt(n);
}

TEST(OneWayAnova, PIsUniformWhenNothingDiffers) {
  RandomStream random(2006, "null one-way");
  std::vector<double> p;
  for (int i = 0; i < 4000; ++i) {
    p.push_back(one_way_anova(random_table(random, 3, 8))->p);
  }
  EXPECT_LT(kolmogorov_smirnov(p), 1.95);
}

TEST(RepeatedAnova, MatchesACaseWorkedByHand) {
  // Row means 3, 5, 7; column means 2, 5, 8; residuals are -1, 0 and 1, each once a row.
  const auto a = repeated_measures_anova({{1, 3, 5}, {2, 4, 9}, {3, 8, 10}});
  ASSERT_TRUE(a);
  EXPECT_DOUBLE_EQ(a->squares_participants, 24.0);
  EXPECT_DOUBLE_EQ(a->squares_condition, 54.0);
  EXPECT_DOUBLE_EQ(a->squares_error, 6.0);
  EXPECT_DOUBLE_EQ(a->f, 18.0);
  EXPECT_NEAR(a->p, 0.01, 1e-15);
  EXPECT_DOUBLE_EQ(a->partial_eta_squared, 0.9);
  EXPECT_NEAR(a->epsilon, 1.0, 1e-14);  // equal covariances: spherical
  EXPECT_NEAR(a->p_corrected, 0.01, 1e-14);
}

TEST(RepeatedAnova, EpsilonIsAtItsBoundWhereOneContrastVaries) {
  // Two participants leave one direction of residuals, whatever the values.
  const auto a = repeated_measures_anova({{1, 4, 2, 8}, {3, 1, 9, 5}});
  ASSERT_TRUE(a);
  EXPECT_NEAR(a->epsilon, 1.0 / 3.0, 1e-14);
  // The corrected degrees of freedom are 1 and 1, for which F has a closed form.
  EXPECT_NEAR(a->p_corrected, 1.0 - 2.0 / std::numbers::pi * std::atan(std::sqrt(a->f)), 1e-14);
}

TEST(RepeatedAnova, OfTwoConditionsIsTheSquareOfThePairedT) {
  RandomStream random(13, "paired");
  for (int i = 0; i < 50; ++i) {
    const Table table = random_table(random, 9, 2);
    std::vector<double> a, b;
    for (const auto& row : table) {
      a.push_back(row[0]);
      b.push_back(row[1]);
    }
    const auto f = repeated_measures_anova(table);
    const auto t = paired_t_test(a, b, Tail::kTwoSided);
    ASSERT_TRUE(f && t);
    EXPECT_NEAR(f->f, t->t * t->t, 1e-11 * (1.0 + f->f));
    EXPECT_NEAR(f->p, t->p, 1e-12);
    EXPECT_NEAR(f->epsilon, 1.0, 1e-12);
  }
}

TEST(RepeatedAnova, IgnoresWhatParticipantsHaveInCommonWithThemselves) {
  RandomStream random(14, "offsets");
  Table table = random_table(random, 6, 3);
  const auto plain = repeated_measures_anova(table);
  for (std::size_t i = 0; i < table.size(); ++i) {
    for (auto& value : table[i]) {
      value = 2.0 * value + 100.0 * static_cast<double>(i);
    }
  }
  const auto moved = repeated_measures_anova(table);
  ASSERT_TRUE(plain && moved);
  EXPECT_NEAR(moved->f, plain->f, 1e-9 * plain->f);
  EXPECT_NEAR(moved->epsilon, plain->epsilon, 1e-9);
}

TEST(RepeatedAnova, PIsUniformWhenNothingDiffers) {
  RandomStream random(2006, "null repeated");
  std::vector<double> p;
  for (int i = 0; i < 4000; ++i) {
    Table table = random_table(random, 12, 3);
    for (auto& row : table) {
      const double participant = 3.0 * random.normal();
      std::for_each(row.begin(), row.end(), [&](double& v) { v += participant; });
    }
    p.push_back(repeated_measures_anova(table)->p);
  }
  EXPECT_LT(kolmogorov_smirnov(p), 1.95);
}

TEST(RepeatedAnova, SaysWhyItIsNotDefined) {
  EXPECT_THAT(repeated_measures_anova({{1, 2, 3}}).because(), HasSubstr("two participants"));
  EXPECT_THAT(repeated_measures_anova({{1}, {2}}).because(), HasSubstr("two conditions"));
  EXPECT_THAT(repeated_measures_anova({{1, 2}, {2}}).because(), HasSubstr("lacks a condition"));
  EXPECT_THAT(repeated_measures_anova({{1, 2}, {kNan, 3}}).because(), HasSubstr("finite"));
  EXPECT_THAT(repeated_measures_anova({{0.1, 0.3}, {0.3, 0.5}, {0.7, 0.9}}).because(),
              HasSubstr("same amount"));
}

}  // namespace
}  // namespace haptrial::analysis::anova_test
