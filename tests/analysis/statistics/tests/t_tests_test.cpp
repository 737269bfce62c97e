#include "analysis/statistics/tests/t_tests.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "analysis/statistics/base/descriptive.h"
#include "analysis/statistics/base/distributions.h"
#include "core/base/random.h"

namespace haptrial::analysis {
namespace {

using testing::HasSubstr;
using Values = std::vector<double>;

// Student's t has closed forms for one and two degrees of freedom.
double t_tail_of_one(double t) { return 0.5 - std::atan(t) / std::numbers::pi; }
double t_tail_of_two(double t) { return 0.5 - t / (2.0 * std::sqrt(2.0 + t * t)); }

TEST(Distributions, HaveTheirClosedForms) {
  for (const double t : {-7.0, -0.3, 0.0, 1.5, 40.0}) {
    EXPECT_NEAR(t_upper_tail(t, 1.0), t_tail_of_one(t), 1e-14);
    EXPECT_NEAR(t_upper_tail(t, 2.0), t_tail_of_two(t), 1e-14);
  }
  EXPECT_NEAR(t_quantile(0.75, 1.0), 1.0, 1e-12);
  EXPECT_NEAR(f_upper_tail(3.0, 2.0, 8.0), std::pow(1.75, -4.0), 1e-15);
}

TEST(StudentT, MatchesACaseWorkedByHand) {
  // Means 2 and 6, squares 2 and 8, pooled variance 2.5, standard error sqrt(5/3).
  const auto t = student_t_test(Values{1, 2, 3}, Values{4, 6, 8}, Tail::kLess);
  ASSERT_TRUE(t);
  EXPECT_DOUBLE_EQ(t->t, -4.0 / std::sqrt(5.0 / 3.0));
  EXPECT_EQ(t->df, 4.0);
  EXPECT_EQ(t->difference, -4.0);
  // With four degrees of freedom P(T > t) = 1/2 - 3/4 (s - s³/3), s = t / sqrt(4 + t²).
  const double s = std::abs(t->t) / std::sqrt(4.0 + t->t * t->t);
  EXPECT_NEAR(t->p, 0.5 - 0.75 * (s - s * s * s / 3.0), 1e-14);
}

TEST(WelchT, MatchesACaseWorkedByHand) {
  // Variances of the means 1/3 and 4/3: df = (5/3)² / ((1/9 + 16/9) / 2) = 50/17.
  const auto t = welch_t_test(Values{1, 2, 3}, Values{4, 6, 8}, Tail::kTwoSided);
  ASSERT_TRUE(t);
  EXPECT_DOUBLE_EQ(t->t, -4.0 / std::sqrt(5.0 / 3.0));
  EXPECT_NEAR(t->df, 50.0 / 17.0, 1e-14);
}

TEST(PairedT, MatchesACaseWorkedByHand) {
  // Differences 1, 2, 3: t = 2 / (1/sqrt(3)), two degrees of freedom.
  const auto t = paired_t_test(Values{2, 4, 7}, Values{1, 2, 4}, Tail::kGreater);
  ASSERT_TRUE(t);
  EXPECT_DOUBLE_EQ(t->t, 2.0 * std::sqrt(3.0));
  EXPECT_NEAR(t->p, t_tail_of_two(t->t), 1e-15);
}

TEST(TTest, TailsFitTogether) {
  RandomStream random(21, "tails");
  Values a(10), b(8);
  for (auto& v : a) {
    v = random.normal();
  }
  for (auto& v : b) {
    v = random.normal() + 0.4;
  }
  for (const auto test : {student_t_test, welch_t_test}) {
    const auto less = test(a, b, Tail::kLess, 0.95);
    const auto greater = test(a, b, Tail::kGreater, 0.95);
    const auto both = test(a, b, Tail::kTwoSided, 0.95);
    EXPECT_NEAR(less->p + greater->p, 1.0, 1e-14);
    EXPECT_NEAR(both->p, 2.0 * std::min(less->p, greater->p), 1e-14);
    EXPECT_DOUBLE_EQ(test(b, a, Tail::kGreater, 0.95)->p, less->p);
    // The interval excludes zero exactly when the two-sided p is below 0.05.
    EXPECT_EQ(both->low > 0.0 || both->high < 0.0, both->p < 0.05);
  }
}

TEST(TTest, IntervalHoldsExactlyTheDifferencesThatItsLevelDoesNotReject) {
  RandomStream random(23, "interval");
  Values a(7), b(11);
  for (auto& v : a) {
    v = random.normal();
  }
  for (auto& v : b) {
    v = 2.0 * random.normal();
  }
  for (const auto test : {student_t_test, welch_t_test}) {
    for (const double level : {0.5, 0.9, 0.99}) {
      const auto t = test(a, b, Tail::kGreater, level);
      for (const double edge : {t->low, t->high}) {
        Values moved = a;
        for (auto& v : moved) {
          v -= edge;
        }
        EXPECT_NEAR(test(moved, b, Tail::kTwoSided, level)->p, 1.0 - level, 1e-12);
      }
      EXPECT_DOUBLE_EQ(t->t * t->error, t->difference);
    }
  }
}

TEST(TTest, SaysWhyItIsNotDefined) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(student_t_test(Values{}, Values{1, 2}, Tail::kLess).because(),
              HasSubstr("no values"));
  EXPECT_THAT(student_t_test(Values{1}, Values{2}, Tail::kLess).because(), HasSubstr("vary"));
  EXPECT_THAT(welch_t_test(Values{1, nan}, Values{2, 3}, Tail::kLess).because(),
              HasSubstr("finite"));
  EXPECT_THAT(welch_t_test(Values{1}, Values{2, 3}, Tail::kLess).because(), HasSubstr("single"));
  EXPECT_THAT(paired_t_test(Values{1}, Values{2}, Tail::kLess).because(), HasSubstr("two pairs"));
  EXPECT_THAT(paired_t_test(Values{0.1, 0.3}, Values{0.3, 0.5}, Tail::kLess).because(),
              HasSubstr("not vary"));
  EXPECT_THROW(paired_t_test(Values{1, 2}, Values{1}, Tail::kLess), std::invalid_argument);
}

TEST(Moments, KeepDigitsBehindALargeConstant) {
  const auto m = moments(Values{1e9 + 0.25, 1e9 + 0.5, 1e9 + 0.75});
  ASSERT_TRUE(m);
  EXPECT_EQ(m->mean(), 1e9 + 0.5);
  EXPECT_EQ(m->squares, 0.125);
  EXPECT_EQ(moments(Values(7, 0.1))->squares, 0.0);
}

TEST(MeanInterval, CoversTheMeanAsOftenAsItSays) {
  RandomStream random(22, "coverage");
  int covered = 0;
  constexpr int kRepeats = 4000;
  for (int i = 0; i < kRepeats; ++i) {
    Values sample(5);
    for (auto& v : sample) {
      v = 3.0 + random.normal();
    }
    const auto interval = mean_interval(sample);
    covered += interval->low < 3.0 && 3.0 < interval->high ? 1 : 0;
  }
  EXPECT_NEAR(covered, 0.95 * kRepeats, 4.0 * std::sqrt(kRepeats * 0.95 * 0.05));
  EXPECT_THAT(mean_interval(Values{1}).because(), HasSubstr("two values"));
}

TEST(Quantile, IsLinearBetweenOrderStatistics) {
  EXPECT_EQ(*quantile(Values{4, 1, 3, 2}, 0.5), 2.5);
  EXPECT_EQ(*quantile(Values{4, 1, 3, 2}, 1.0), 4.0);
  EXPECT_FALSE(quantile(Values{}, 0.5));
}

}  // namespace
}  // namespace haptrial::analysis
