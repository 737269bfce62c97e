#include "analysis/statistics/tests/wilcoxon.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <stdexcept>
#include <vector>

#include "analysis/statistics/base/descriptive.h"
#include "analysis/statistics/tests/permutation.h"
#include "core/base/random.h"

namespace haptrial::analysis::wilcoxon_test {
namespace {

using testing::HasSubstr;
using Values = std::vector<double>;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Values drawn(RandomStream& random, std::size_t count) {
  Values result(count);
  for (auto& value : result) {
    value = random.normal();
  }
  return result;
}

struct Tails {
  double at_most{0.0};
  double at_least{0.0};
};

// The share of all 2^n choices of signs whose statistic is as small or as large.
Tails all_signs(const Values& differences, double statistic) {
  const std::size_t n = differences.size();
  Tails result;
  for (std::size_t signs = 0; signs < std::size_t{1} << n; ++signs) {
    Values signed_values;
    for (std::size_t i = 0; i < n; ++i) {
      signed_values.push_back((signs >> i & 1) != 0 ? std::abs(differences[i])
                                                    : -std::abs(differences[i]));
    }
    double v = 0.0;  // from the definition: sums of two that are positive (Tukey)
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = i; j < n; ++j) {
        v += signed_values[i] + signed_values[j] > 0.0 ? 1.0 : 0.0;
      }
    }
    result.at_most += v <= statistic ? 1.0 : 0.0;
    result.at_least += v >= statistic ? 1.0 : 0.0;
  }
  const auto count = static_cast<double>(std::size_t{1} << n);
  return {result.at_most / count, result.at_least / count};
}

TEST(WilcoxonSignedRank, IsTheShareOfAllChoicesOfSigns) {
  RandomStream random(41, "signs");
  for (std::size_t n = 1; n <= 10; ++n) {
    const Values a = drawn(random, n);
    const Values zero(n, 0.0);
    const auto test = wilcoxon_signed_rank(a, zero, Tail::kLess);
    const Tails tails = all_signs(a, test->statistic);
    EXPECT_TRUE(test->exact);
    EXPECT_NEAR(test->p, tails.at_most, 1e-15);
    EXPECT_NEAR(wilcoxon_signed_rank(a, zero, Tail::kGreater)->p, tails.at_least, 1e-15);
    EXPECT_NEAR(wilcoxon_signed_rank(a, zero, Tail::kTwoSided)->p,
                std::min(1.0, 2.0 * std::min(tails.at_most, tails.at_least)), 1e-15);
  }
}

// The share of all ways to choose a sample's values among all.
Tails all_choices(const Values& all, std::size_t of_first, double statistic) {
  Tails result;
  double count = 0.0;
  for (std::size_t chosen = 0; chosen < std::size_t{1} << all.size(); ++chosen) {
    if (static_cast<std::size_t>(__builtin_popcountll(chosen)) != of_first) {
      continue;
    }
    double u = 0.0;
    for (std::size_t i = 0; i < all.size(); ++i) {
      for (std::size_t j = 0; j < all.size(); ++j) {
        const bool pair = (chosen >> i & 1) != 0 && (chosen >> j & 1) == 0;
        u += pair && all[i] > all[j] ? 1.0 : 0.0;
      }
    }
    count += 1.0;
    result.at_most += u <= statistic ? 1.0 : 0.0;
    result.at_least += u >= statistic ? 1.0 : 0.0;
  }
  return {result.at_most / count, result.at_least / count};
}

TEST(MannWhitney, IsTheShareOfAllChoicesOfTheFirstSample) {
  RandomStream random(42, "choices");
  for (const auto& [m, n] : {std::pair<std::size_t, std::size_t>{1, 1}, {1, 6}, {5, 2}, {6, 6}}) {
    const Values a = drawn(random, m);
    const Values b = drawn(random, n);
    Values all = a;
    all.insert(all.end(), b.begin(), b.end());
    const auto test = mann_whitney(a, b, Tail::kLess);
    const Tails tails = all_choices(all, m, test->statistic);
    EXPECT_TRUE(test->exact);
    EXPECT_NEAR(test->p, tails.at_most, 1e-15);
    EXPECT_NEAR(mann_whitney(a, b, Tail::kGreater)->p, tails.at_least, 1e-15);
  }
}

TEST(MannWhitney, TurnsAroundWithItsSamples) {
  RandomStream random(43, "turned");
  for (const std::size_t n : {8u, 70u}) {  // exact and approximate
    const Values a = drawn(random, n);
    const Values b = drawn(random, 9);
    const auto forward = mann_whitney(a, b, Tail::kLess);
    const auto backward = mann_whitney(b, a, Tail::kGreater);
    EXPECT_EQ(forward->exact, n < 50);
    EXPECT_NEAR(forward->p, backward->p, 1e-15);
    EXPECT_EQ(forward->statistic + backward->statistic, static_cast<double>(n * 9));
  }
}

TEST(RankTests, SeeOnlyTheOrder) {
  RandomStream random(44, "order");
  const Values a = drawn(random, 12), b = drawn(random, 15);
  const auto bent = [](Values values) {
    for (auto& value : values) {
      value = std::exp(3.0 * value);
    }
    return values;
  };
  EXPECT_EQ(mann_whitney(a, b, Tail::kTwoSided)->p,
            mann_whitney(bent(a), bent(b), Tail::kTwoSided)->p);
}

// Ratings tie. Six pairs that rise by one have the smallest p there is, 2 of 64 signs; the first
// sample has the four smallest of eight values in one choice of 70.
TEST(RankTests, AreExactWithTies) {
  const Values before{3, 2, 4, 1, 2, 3}, after{4, 3, 5, 2, 3, 4};
  const auto pairs = wilcoxon_signed_rank(before, after, Tail::kTwoSided);
  EXPECT_TRUE(pairs->exact);
  EXPECT_DOUBLE_EQ(pairs->p, 2.0 / 64.0);
  EXPECT_DOUBLE_EQ(wilcoxon_signed_rank(before, after, Tail::kLess)->p, 1.0 / 64.0);
  const auto groups = mann_whitney(Values{1, 1, 2, 2}, Values{3, 3, 3, 4}, Tail::kTwoSided);
  EXPECT_TRUE(groups->exact);
  EXPECT_DOUBLE_EQ(groups->p, 2.0 / 70.0);
}

// An equal pair tells nothing: without it the test is the same.
TEST(WilcoxonSignedRank, IsExactWithEqualPairs) {
  const auto with = wilcoxon_signed_rank(Values{1, 5, 2, 7, 4}, Values{1, 3, 1, 2, 7}, Tail::kLess);
  const auto without = wilcoxon_signed_rank(Values{5, 2, 7, 4}, Values{3, 1, 2, 7}, Tail::kLess);
  EXPECT_TRUE(with->exact);
  EXPECT_EQ(with->count, 4u);
  EXPECT_EQ(with->p, without->p);
}

// p of fifty values is approximate; drawn arrangements of their ranks give the same to 0.01.
TEST(RankTests, ApproximateTheExactP) {
  RandomStream random(45, "approximation");
  Values a = drawn(random, 50), b = drawn(random, 50);
  Values all = a;
  all.insert(all.end(), b.begin(), b.end());
  const Values ranks = midranks(all)->ranks;
  const auto approximate = mann_whitney(a, b, Tail::kTwoSided);
  EXPECT_FALSE(approximate->exact);
  const Resampling many{1, "ranks", 100'000, 2};
  const std::span<const double> ranked(ranks);
  EXPECT_NEAR(approximate->p,
              permutation_test(ranked.first(50), ranked.last(50), Tail::kTwoSided, many)->p, 0.01);
  const Values zero(50, 0.0);
  const auto signs = wilcoxon_signed_rank(b, zero, Tail::kTwoSided);
  EXPECT_FALSE(signs->exact);
  Values signed_ranks = midranks([&] {
                          Values sizes = b;
                          for (double& size : sizes) {
                            size = std::abs(size);
                          }
                          return sizes;
                        }())
                            ->ranks;
  for (std::size_t i = 0; i < b.size(); ++i) {
    signed_ranks[i] = std::copysign(signed_ranks[i], b[i]);
  }
  EXPECT_NEAR(signs->p, sign_flip_test(signed_ranks, zero, Tail::kTwoSided, many)->p, 0.01);
}

TEST(RankTests, RejectAsOftenAsTheySay) {
  RandomStream random(46, "null ranks");
  int rejected = 0, rejected_pairs = 0;
  constexpr int kRepeats = 4000;
  for (int i = 0; i < kRepeats; ++i) {
    const Values a = drawn(random, 10), b = drawn(random, 10);
    rejected += mann_whitney(a, b, Tail::kTwoSided)->p <= 0.05 ? 1 : 0;
    rejected_pairs += wilcoxon_signed_rank(a, b, Tail::kTwoSided)->p <= 0.05 ? 1 : 0;
  }
  // The largest levels of 10 and 10 up to 0.05: U <= 23 has 0.0433, V <= 8 has 0.0488.
  EXPECT_NEAR(rejected / double{kRepeats}, 0.0433, 4.0 * std::sqrt(0.0433 * 0.957 / kRepeats));
  EXPECT_NEAR(rejected_pairs / double{kRepeats}, 0.0488,
              4.0 * std::sqrt(0.0488 * 0.951 / kRepeats));
}

TEST(RankTests, SayWhyTheyAreNotDefined) {
  EXPECT_THAT(wilcoxon_signed_rank(Values{}, Values{}, Tail::kLess).because(),
              HasSubstr("no values"));
  EXPECT_THAT(wilcoxon_signed_rank(Values{1, 2}, Values{1, 2}, Tail::kLess).because(),
              HasSubstr("every pair are equal"));
  EXPECT_THAT(wilcoxon_signed_rank(Values{1, kNan}, Values{1, 2}, Tail::kLess).because(),
              HasSubstr("finite"));
  EXPECT_THROW(wilcoxon_signed_rank(Values{1}, Values{1, 2}, Tail::kLess), std::invalid_argument);
  EXPECT_THAT(mann_whitney(Values{}, Values{1}, Tail::kLess).because(), HasSubstr("no values"));
  EXPECT_THAT(mann_whitney(Values{2, 2}, Values{2}, Tail::kLess).because(),
              HasSubstr("all values"));
  EXPECT_THAT(mann_whitney(Values{2, kNan}, Values{2}, Tail::kLess).because(), HasSubstr("finite"));
}

}  // namespace
}  // namespace haptrial::analysis::wilcoxon_test
