#include "analysis/statistics/variance/rank_anova.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "analysis/statistics/base/descriptive.h"
#include "analysis/statistics/base/distributions.h"
#include "analysis/statistics/tests/wilcoxon.h"
#include "analysis/statistics/variance/anova.h"
#include "core/base/random.h"

namespace haptrial::analysis::rank_anova_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using Table = std::vector<std::vector<double>>;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(Ranks, ShareTheMeanRankOfTies) {
  const auto ranks = midranks(std::vector<double>{5, 1, 5, 3, 5, 1});
  EXPECT_THAT(ranks->ranks, ElementsAre(5, 1.5, 5, 3, 5, 1.5));
  EXPECT_EQ(ranks->ties, 24.0 + 6.0);
  EXPECT_FALSE(ranks->all_tied());
  EXPECT_TRUE(midranks(std::vector<double>{2, 2, 2})->all_tied());
  EXPECT_THAT(midranks(std::vector<double>{1, kNan}).because(), HasSubstr("finite"));
}

Table rounded_groups(RandomStream& random) {
  Table groups{std::vector<double>(5), std::vector<double>(8), std::vector<double>(3)};
  for (auto& group : groups) {
    for (auto& value : group) {
      value = std::floor(6.0 * random.uniform());
    }
  }
  return groups;
}

// Kruskal and Wallis' statistic is the analysis of variance of the ranks, held against the variance
// of all ranks: (N - 1) SS_between / SS_total, with ties or without.
TEST(KruskalWallis, IsTheAnalysisOfVarianceOfTheRanks) {
  RandomStream random(51, "kruskal");
  for (int round = 0; round < 20; ++round) {
    const Table groups = rounded_groups(random);
    std::vector<double> all;
    for (const auto& group : groups) {
      all.insert(all.end(), group.begin(), group.end());
    }
    const auto ranks = midranks(all);
    Table ranked = groups;
    auto next = ranks->ranks.begin();
    for (auto& group : ranked) {
      for (auto& value : group) {
        value = *next++;
      }
    }
    const auto anova = one_way_anova(ranked);
    const auto test = kruskal_wallis(groups);
    ASSERT_TRUE(anova && test);
    EXPECT_NEAR(test->chi_squared, 15.0 * anova->eta_squared, 1e-12);
    EXPECT_EQ(test->df, 2.0);
    EXPECT_FALSE(test->exact);
    EXPECT_NEAR(test->p, std::exp(-0.5 * test->chi_squared), 1e-14);  // chi squared of two df
  }
}

TEST(KruskalWallis, SaysWhyItIsNotDefined) {
  EXPECT_THAT(kruskal_wallis({{1, 2}}).because(), HasSubstr("fewer than two groups"));
  EXPECT_THAT(kruskal_wallis({{1, 2}, {}}).because(), HasSubstr("empty"));
  EXPECT_THAT(kruskal_wallis({{1}, {2}}).because(), HasSubstr("single value"));
  EXPECT_THAT(kruskal_wallis({{4, 4}, {4}}).because(), HasSubstr("all values are equal"));
  EXPECT_THAT(kruskal_wallis({{4, kNan}, {3}}).because(), HasSubstr("finite"));
}

// Two groups: Mann and Whitney's test, both of whose statistics rise with the distance of the rank
// sum from its expectation.
TEST(KruskalWallis, OfTwoGroupsIsMannAndWhitney) {
  RandomStream random(53, "two groups");
  for (int round = 0; round < 10; ++round) {
    Table groups{std::vector<double>(4), std::vector<double>(7)};
    for (auto& group : groups) {
      for (auto& value : group) {
        value = std::floor(6.0 * random.uniform());
      }
    }
    const auto test = kruskal_wallis(groups);
    EXPECT_TRUE(test->exact);
    EXPECT_NEAR(test->p, mann_whitney(groups[0], groups[1], Tail::kTwoSided)->p, 1e-12);
  }
}

// The published table of three groups of two has 0.0667 for 4.571 (Kruskal and Wallis 1952): the 6
// orders of groups apart among the 90 arrangements.
TEST(KruskalWallis, IsExactForFewValues) {
  const auto test = kruskal_wallis({{1, 2}, {3, 4}, {5, 6}});
  EXPECT_TRUE(test->exact);
  EXPECT_NEAR(test->chi_squared, 4.571, 1e-3);
  EXPECT_NEAR(test->p, 6.0 / 90.0, 1e-14);
}

// For two conditions Friedman's test is the sign test: (n+ - n-)² / (n+ + n-), equal pairs left
// out. Four or more of five signs agree in 12 of 32 cases.
TEST(Friedman, OfTwoConditionsIsTheSignTest) {
  const auto test = friedman({{1, 2}, {5, 3}, {2, 8}, {4, 4}, {1, 7}, {0, 9}});
  ASSERT_TRUE(test);
  EXPECT_DOUBLE_EQ(test->chi_squared, (4.0 - 1.0) * (4.0 - 1.0) / 5.0);
  EXPECT_NEAR(test->p, 12.0 / 32.0, 1e-14);
  const auto four = friedman({{1, 2}, {1, 3}, {2, 3.5}, {1, 1.7}});
  EXPECT_TRUE(four->exact);
  EXPECT_NEAR(four->p, 2.0 / 16.0, 1e-14);
}

TEST(Friedman, MatchesACaseWorkedByHand) {
  // Rank sums 4, 8, 12 of four participants who agree: 12 (16 + 0 + 16) / (4 3 4). All agree in 6
  // of 6⁴ arrangements.
  const auto test = friedman({{1, 2, 3}, {10, 20, 30}, {0, 5, 6}, {7, 8, 9}});
  EXPECT_DOUBLE_EQ(test->chi_squared, 8.0);
  EXPECT_NEAR(test->p, 6.0 / 1296.0, 1e-14);
}

// With more than twelve participants, and with too many arrangements, p is that of chi squared.
TEST(Friedman, SaysWhetherPIsExact) {
  RandomStream random(54, "many");
  const auto made = [&](std::size_t people, std::size_t conditions) {
    Table table(people, std::vector<double>(conditions));
    for (auto& row : table) {
      for (auto& value : row) {
        value = random.normal();
      }
    }
    return *friedman(table);
  };
  for (const std::size_t conditions : {2u, 3u, 4u}) {
    EXPECT_TRUE(made(12, conditions).exact) << conditions;
  }
  for (const auto& [people, conditions] : {std::pair{13, 3}, {12, 9}}) {
    const RankAnova test =
        made(static_cast<std::size_t>(people), static_cast<std::size_t>(conditions));
    EXPECT_FALSE(test.exact);
    EXPECT_EQ(test.p, chi_squared_upper_tail(test.chi_squared, test.df));
  }
}

TEST(Friedman, IgnoresWhatIsCommonToAParticipant) {
  RandomStream random(52, "friedman");
  Table table(7, std::vector<double>(4));
  for (auto& row : table) {
    for (auto& value : row) {
      value = random.normal();
    }
  }
  const auto plain = friedman(table);
  for (std::size_t i = 0; i < table.size(); ++i) {
    for (auto& value : table[i]) {
      value = std::exp(value) + 100.0 * static_cast<double>(i);
    }
  }
  EXPECT_EQ(friedman(table)->p, plain->p);
}

TEST(Friedman, SaysWhyItIsNotDefined) {
  EXPECT_THAT(friedman({{1, 2}}).because(), HasSubstr("two participants"));
  EXPECT_THAT(friedman({{1}, {2}}).because(), HasSubstr("two conditions"));
  EXPECT_THAT(friedman({{1, 2}, {1}}).because(), HasSubstr("lacks"));
  EXPECT_THAT(friedman({{1, 1}, {3, 3}}).because(), HasSubstr("all equal"));
  EXPECT_THAT(friedman({{1, kNan}, {3, 4}}).because(), HasSubstr("finite"));
}

}  // namespace
}  // namespace haptrial::analysis::rank_anova_test
