#include "analysis/statistics/tests/permutation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/base/random.h"
#include "tests/analysis/statistics/normal_values.h"

namespace haptrial::analysis {
namespace {

using test::normal_values;
using testing::HasSubstr;
using Values = std::vector<double>;

TEST(PermutationTest, CountsTheArrangementsOfACaseWorkedByHand) {
  // Among the six pairs out of 1, 2, 3, 4 one has the lowest sum and one the highest.
  const Values a{1, 2}, b{3, 4};
  EXPECT_DOUBLE_EQ(permutation_test(a, b, Tail::kTwoSided, {})->p, 2.0 / 6.0);
  EXPECT_DOUBLE_EQ(permutation_test(a, b, Tail::kLess, {})->p, 1.0 / 6.0);
  EXPECT_DOUBLE_EQ(permutation_test(a, b, Tail::kGreater, {})->p, 1.0);
  EXPECT_EQ(permutation_test(a, b, Tail::kLess, {})->difference, -2.0);
  EXPECT_EQ(permutation_test(a, b, Tail::kLess, {})->arrangements, 6u);
  EXPECT_TRUE(permutation_test(a, b, Tail::kLess, {})->exact);
}

TEST(PermutationTest, TiesThatRoundingPartsStayTies) {
  // 0.1 + 0.2 and 0.3 + 0.0 are equal sums, but not in doubles.
  const Values a{0.1, 0.2}, b{0.3, 0.0};
  EXPECT_DOUBLE_EQ(permutation_test(a, b, Tail::kLess, {})->p, 4.0 / 6.0);
  EXPECT_DOUBLE_EQ(permutation_test(a, b, Tail::kTwoSided, {})->p, 1.0);
}

TEST(PermutationTest, DrawsWhatCannotBeCounted) {
  RandomStream random(1, "samples");
  const Values a = normal_values(random, 14, 0.6);
  const Values b = normal_values(random, 14, 0.0);
  const auto drawn = permutation_test(a, b, Tail::kTwoSided, {1, "p", 40000, 1});
  ASSERT_TRUE(drawn);
  EXPECT_FALSE(drawn->exact);
  EXPECT_EQ(drawn->arrangements, 40000u);
  // The test approaches Student's for well-behaved samples.
  const double expected = student_t_test(a, b, Tail::kTwoSided)->p;
  EXPECT_NEAR(drawn->p, expected, 0.004 + 4.0 * std::sqrt(expected / 40000.0));
  for (const int threads : {2, 5}) {
    EXPECT_EQ(permutation_test(a, b, Tail::kTwoSided, {1, "p", 40000, threads})->p, drawn->p);
  }
  EXPECT_NE(permutation_test(a, b, Tail::kTwoSided, {2, "p", 40000, 1})->p, drawn->p);
}

TEST(PermutationTest, NeverGivesZero) {
  RandomStream random(2, "far");
  const auto far = permutation_test(normal_values(random, 20, 50.0), normal_values(random, 20, 0.0),
                                    Tail::kTwoSided, {1, "p", 999, 1});
  EXPECT_DOUBLE_EQ(far->p, 0.001);
}

TEST(PermutationTest, IsExactlyUniformOverItsArrangements) {
  // Every split of five different values into two and three: of the ten one-sided p values each
  // tenth comes once.
  const Values values{1, 2.5, 3.75, 7, 12.5};
  std::vector<double> p;
  for (std::size_t i = 0; i < values.size(); ++i) {
    for (std::size_t j = i + 1; j < values.size(); ++j) {
      Values b;
      for (std::size_t k = 0; k < values.size(); ++k) {
        if (k != i && k != j) {
          b.push_back(values[k]);
        }
      }
      p.push_back(permutation_test(Values{values[i], values[j]}, b, Tail::kLess, {})->p);
    }
  }
  std::sort(p.begin(), p.end());
  for (std::size_t i = 0; i < p.size(); ++i) {
    EXPECT_DOUBLE_EQ(p[i], static_cast<double>(i + 1) / 10.0);
  }
}

TEST(SignFlip, CountsTheArrangementsOfACaseWorkedByHand) {
  // Differences 1, 2, 4: all eight sums differ, and the one found is the highest.
  const Values a{2, 4, 8}, b{1, 2, 4};
  EXPECT_DOUBLE_EQ(sign_flip_test(a, b, Tail::kGreater, {})->p, 1.0 / 8.0);
  EXPECT_DOUBLE_EQ(sign_flip_test(a, b, Tail::kTwoSided, {})->p, 2.0 / 8.0);
  EXPECT_DOUBLE_EQ(sign_flip_test(b, a, Tail::kLess, {})->p, 1.0 / 8.0);
}

TEST(SignFlip, DrawsWhatCannotBeCounted) {
  RandomStream random(3, "pairs");
  const Values a = normal_values(random, 70, 0.25);
  const Values b = normal_values(random, 70, 0.0);
  const auto drawn = sign_flip_test(a, b, Tail::kTwoSided, {1, "p", 40000, 1});
  EXPECT_FALSE(drawn->exact);
  const double expected = paired_t_test(a, b, Tail::kTwoSided)->p;
  EXPECT_NEAR(drawn->p, expected, 0.004 + 4.0 * std::sqrt(expected / 40000.0));
  EXPECT_EQ(sign_flip_test(a, b, Tail::kTwoSided, {1, "p", 40000, 4})->p, drawn->p);
}

TEST(SignFlip, OfTwentyPairsDrawnAgreesWithNineteenCounted) {
  RandomStream random(4, "pairs");
  Values a = normal_values(random, 19, 0.4);
  Values b = normal_values(random, 19, 0.0);
  const auto counted = sign_flip_test(a, b, Tail::kTwoSided, {});
  EXPECT_TRUE(counted->exact);
  a.push_back(1.0);  // a pair without a difference changes nothing
  b.push_back(1.0);
  const auto drawn = sign_flip_test(a, b, Tail::kTwoSided, {1, "p", 50000, 2});
  EXPECT_FALSE(drawn->exact);
  EXPECT_NEAR(drawn->p, counted->p, 4.0 * std::sqrt(counted->p / 50000.0));
}

TEST(PermutationTest, IsRightWhereThereIsLittleToSee) {
  EXPECT_EQ(permutation_test(Values{3}, Values{5}, Tail::kTwoSided, {})->p, 1.0);
  EXPECT_EQ(permutation_test(Values{3, 3}, Values{3, 3}, Tail::kTwoSided, {})->p, 1.0);
  EXPECT_EQ(sign_flip_test(Values{3}, Values{5}, Tail::kTwoSided, {})->p, 1.0);
  EXPECT_EQ(sign_flip_test(Values{3, 4}, Values{3, 4}, Tail::kTwoSided, {})->p, 1.0);
}

TEST(PermutationTest, SaysWhyItIsNotDefined) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(permutation_test(Values{}, Values{1}, Tail::kLess, {}).because(),
              HasSubstr("no values"));
  EXPECT_THAT(permutation_test(Values{1, nan}, Values{1}, Tail::kLess, {}).because(),
              HasSubstr("finite"));
  EXPECT_FALSE(permutation_test(Values{1e308}, Values{-1e308}, Tail::kLess, {}));
  EXPECT_THAT(sign_flip_test(Values{}, Values{}, Tail::kLess, {}).because(),
              HasSubstr("no values"));
  EXPECT_THROW(sign_flip_test(Values{1}, Values{1, 2}, Tail::kLess, {}), std::invalid_argument);
}

}  // namespace
}  // namespace haptrial::analysis
