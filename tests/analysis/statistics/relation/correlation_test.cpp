#include "analysis/statistics/relation/correlation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "analysis/statistics/relation/regression.h"
#include "core/base/random.h"
#include "tests/analysis/statistics/normal_values.h"

namespace haptrial::analysis {
namespace {

using test::normal_values;
using testing::HasSubstr;
using Values = std::vector<double>;

TEST(Pearson, MatchesACaseWorkedByHand) {
  // Sxx 2, Syy 2, Sxy 1; with one degree of freedom t = 1/sqrt(3) and p = 2/3.
  const auto c = pearson_correlation(Values{1, 2, 3}, Values{1, 3, 2});
  ASSERT_TRUE(c);
  EXPECT_NEAR(c->r, 0.5, 1e-15);
  EXPECT_NEAR(c->p, 2.0 / 3.0, 1e-14);
  EXPECT_THAT(c->interval.because(), HasSubstr("four pairs"));
}

TEST(Pearson, AgreesWithTheSlopeOfARegression) {
  RandomStream random(1, "slope");
  for (int i = 0; i < 20; ++i) {
    const Values a = normal_values(random, 12), b = normal_values(random, 12);
    const auto c = pearson_correlation(a, b);
    const auto fit = linear_regression(a, b);
    EXPECT_NEAR(c->p, fit->p, 1e-13);
    EXPECT_NEAR(c->r * c->r, fit->r_squared, 1e-14);
    EXPECT_EQ(std::signbit(c->r), std::signbit(fit->coefficients[1].estimate));
  }
}

TEST(Pearson, DoesNotMindOffsetAndScale) {
  RandomStream random(2, "offset");
  Values a = normal_values(random, 15), b = normal_values(random, 15);
  for (auto* values : {&a, &b}) {
    for (auto& v : *values) {
      v = std::round(64.0 * v) / 64.0;
    }
  }
  const auto plain = pearson_correlation(a, b);
  for (auto& v : a) {
    v = -4.0 * v + 1e12;
  }
  for (auto& v : b) {
    v += 1e12;
  }
  const auto moved = pearson_correlation(a, b);
  EXPECT_NEAR(moved->r, -plain->r, 1e-14);
  EXPECT_NEAR(moved->interval->low, -plain->interval->high, 1e-14);
}

TEST(Pearson, OfALineIsOneAndCertain) {
  const auto c = pearson_correlation(Values{1, 2, 3, 4, 5}, Values{10, 8, 6, 4, 2});
  EXPECT_NEAR(c->r, -1.0, 1e-15);
  EXPECT_LT(c->p, 1e-20);
  EXPECT_NEAR(c->interval->low, -1.0, 1e-7);
  EXPECT_NEAR(c->interval->high, -1.0, 1e-7);
}

TEST(Spearman, CountsArrangements) {
  // Among the 24 orders of four only the two monotone ones are as strong.
  const auto c = spearman_correlation(Values{1, 2, 3, 4}, Values{1, 8, 27, 64});
  EXPECT_DOUBLE_EQ(c->r, 1.0);
  EXPECT_DOUBLE_EQ(c->p, 2.0 / 24.0);
}

TEST(Spearman, SeesOnlyOrder) {
  RandomStream random(3, "order");
  const Values a = normal_values(random, 25), b = normal_values(random, 25);
  Values curved = b;
  for (auto& v : curved) {
    v = std::exp(v) + 1e6;
  }
  EXPECT_EQ(spearman_correlation(a, b)->r, spearman_correlation(a, curved)->r);
  EXPECT_EQ(spearman_correlation(a, b)->p, spearman_correlation(a, curved)->p);
}

TEST(Spearman, SeriesAgreesWithRandomOrders) {
  // Twelve pairs: the share of 40000 random orders that are as strong.
  const Values a{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
  const Values b{2, 1, 6, 3, 9, 4, 5, 12, 8, 11, 7, 10};
  const auto c = spearman_correlation(a, b);
  RandomStream random(4, "orders");
  constexpr int kOrders = 40000;
  int as_strong = 0;
  Values order = a;
  const double found = std::abs(std::inner_product(a.begin(), a.end(), b.begin(), 0.0) - 507.0);
  for (int i = 0; i < kOrders; ++i) {
    for (std::size_t k = order.size(); k > 1; --k) {
      std::swap(order[k - 1], order[random.below(k)]);
    }
    const double sum = std::inner_product(a.begin(), a.end(), order.begin(), 0.0);
    as_strong += std::abs(sum - 507.0) >= found ? 1 : 0;
  }
  const double share = static_cast<double>(as_strong) / kOrders;
  EXPECT_NEAR(c->p, share, 0.0005 + 4.0 * std::sqrt(share / kOrders));
}

TEST(Correlation, SaysWhyItIsNotDefined) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const auto& correlation : {&pearson_correlation, &spearman_correlation}) {
    EXPECT_THAT(correlation(Values{}, Values{}, 0.95).because(), HasSubstr("no values"));
    EXPECT_THAT(correlation(Values{1, 2}, Values{2, 1}, 0.95).because(), HasSubstr("three pairs"));
    EXPECT_THAT(correlation(Values{1, 2, nan}, Values{2, 1, 3}, 0.95).because(),
                HasSubstr("finite"));
    EXPECT_THAT(correlation(Values{1, 2, 3}, Values{7, 7, 7}, 0.95).because(), HasSubstr("vary"));
    EXPECT_THROW(correlation(Values{1, 2, 3}, Values{1, 2}, 0.95), std::invalid_argument);
  }
}

}  // namespace
}  // namespace haptrial::analysis
