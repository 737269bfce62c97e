// Levene's test and Shapiro and Wilk's: what a report says about its assumptions.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "analysis/statistics/tests/shapiro_wilk.h"
#include "analysis/statistics/variance/anova.h"
#include "core/base/random.h"

namespace haptrial::analysis::checks_test {
namespace {

using testing::HasSubstr;
using Values = std::vector<double>;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(Levene, MatchesACaseWorkedByHand) {
  // Distances 1, 0, 1 and 3, 0, 3 from the means: means 2/3 and 2, squares 2/3 and 6, between 8/3.
  const auto a = levene({{1, 2, 3}, {4, 7, 10}}, Centre::kMean);
  ASSERT_TRUE(a);
  EXPECT_NEAR(a->f, (8.0 / 3.0) / ((2.0 / 3.0 + 6.0) / 4.0), 1e-14);
}

TEST(Levene, OfSkewedDataDependsOnTheCentre) {
  // Medians 0 and 0: distances 0, 0, 9 and 0, 0, 30; means 3 and 10.
  const auto a = levene({{0, 0, 9}, {0, 30, 0}}, Centre::kMedian);
  ASSERT_TRUE(a);
  EXPECT_NEAR(a->f, 73.5 / ((54.0 + 600.0) / 4.0), 1e-14);
  EXPECT_NE(levene({{0, 0, 9}, {0, 30, 0}}, Centre::kMean)->f, a->f);
}

TEST(Levene, SaysWhyItIsNotDefined) {
  for (const Centre centre : {Centre::kMean, Centre::kMedian}) {
    EXPECT_THAT(levene({{1, 2}}, centre).because(), HasSubstr("fewer than two groups"));
    EXPECT_THAT(levene({{1, 2, 4}, {}}, centre).because(), HasSubstr("empty"));
    EXPECT_THAT(levene({{1, 2, 4}, {1, kNan}}, centre).because(), HasSubstr("finite"));
    EXPECT_THAT(levene({{1, 2.1}, {3, 4.7}}, centre).because(), HasSubstr("equally far"));
    EXPECT_THAT(levene({{0.1, 0.1}, {0.7, 0.7}}, centre).because(), HasSubstr("equally far"));
  }
}

TEST(ShapiroWilk, OfThreeValuesIsExact) {
  // W = (x3 - x1)² / (2 SS); 1, 2, 4: 9 / (2 14/3). P(W <= w) = 6/pi (asin √w - asin √(3/4)).
  const auto s = shapiro_wilk(Values{4, 1, 2});
  ASSERT_TRUE(s);
  EXPECT_NEAR(s->w, 27.0 / 28.0, 1e-15);
  EXPECT_NEAR(s->p,
              6.0 / std::numbers::pi * (std::asin(std::sqrt(27.0 / 28.0)) - std::numbers::pi / 3.0),
              1e-14);
  EXPECT_NEAR(shapiro_wilk(Values{1, 2, 3})->p, 1.0, 1e-7);
}

// The same sample and formulas in arithmetic of 40 digits gave 1 - W to all digits; R is off by
// 2e-11 of p here, because it loses 1 - W behind W.
TEST(ShapiroWilk, KeepsTheDigitsOfALargeSample) {
  Values values;
  for (long i = 1; i <= 5000; ++i) {
    values.push_back(
        static_cast<double>((i * 7919) % 5003 + (i * 104729) % 5009 + (i * 1299709) % 5011) / 64.0);
  }
  const auto s = shapiro_wilk(values);
  EXPECT_NEAR(s->w, 0.99672479921896978996, 2e-16);
  EXPECT_NEAR(s->p, 5.0720878104348331085e-9, 1e-12 * 5.07e-9);
}

TEST(ShapiroWilk, IgnoresShiftScaleAndOrder) {
  RandomStream random(61, "shapiro");
  Values values(40);
  for (auto& value : values) {
    value = random.normal();
  }
  const auto plain = shapiro_wilk(values);
  for (auto& value : values) {
    value = 100.0 - 7.0 * value;
  }
  std::reverse(values.begin(), values.end());
  EXPECT_NEAR(shapiro_wilk(values)->w, plain->w, 1e-13);
}

TEST(ShapiroWilk, RejectsNormalSamplesAsOftenAsItSaysAndSkewedOnesMoreOften) {
  RandomStream random(62, "normal samples");
  for (const std::size_t n : {5u, 11u, 12u, 50u}) {
    int rejected = 0, rejected_skewed = 0;
    constexpr int kRepeats = 2000;
    for (int i = 0; i < kRepeats; ++i) {
      Values normal(n), skewed(n);
      for (std::size_t k = 0; k < n; ++k) {
        normal[k] = random.normal();
        skewed[k] = std::exp(random.normal());
      }
      rejected += shapiro_wilk(normal)->p < 0.05 ? 1 : 0;
      rejected_skewed += shapiro_wilk(skewed)->p < 0.05 ? 1 : 0;
    }
    EXPECT_NEAR(rejected, 0.05 * kRepeats, 5.0 * std::sqrt(0.05 * 0.95 * kRepeats)) << n;
    EXPECT_GT(rejected_skewed, 2 * rejected) << n;
  }
}

TEST(ShapiroWilk, SaysWhyItIsNotDefined) {
  EXPECT_THAT(shapiro_wilk(Values{}).because(), HasSubstr("no values"));
  EXPECT_THAT(shapiro_wilk(Values{1, 2}).because(), HasSubstr("fewer than three"));
  EXPECT_THAT(shapiro_wilk(Values{1, 2, kNan}).because(), HasSubstr("finite"));
  EXPECT_THAT(shapiro_wilk(Values(9, 0.1)).because(), HasSubstr("all values are equal"));
  Values many(5001, 0.0);
  many[0] = 1.0;
  EXPECT_THAT(shapiro_wilk(many).because(), HasSubstr("more than 5000"));
}

}  // namespace
}  // namespace haptrial::analysis::checks_test
