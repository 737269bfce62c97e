#include <gmock/gmock.h>
#include <gsl/gsl_randist.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "analysis/statistics/base/descriptive.h"
#include "analysis/statistics/base/distributions.h"
#include "analysis/statistics/tests/t_tests.h"
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
  const Mean same = mean_and_interval(Values{0.1, 0.1, 0.1});
  EXPECT_DOUBLE_EQ(*same.value, 0.1);
  EXPECT_THAT(same.interval.because(), HasSubstr("do not vary"));
  EXPECT_THAT(mean_interval(Values{0.3, 0.1 + 0.2}).because(), HasSubstr("do not vary"));
}

TEST(Quantile, IsLinearBetweenOrderStatistics) {
  EXPECT_EQ(*quantile(Values{4, 1, 3, 2}, 0.5), 2.5);
  EXPECT_EQ(*quantile(Values{4, 1, 3, 2}, 1.0), 4.0);
  EXPECT_FALSE(quantile(Values{}, 0.5));
}

const std::vector<double> kA{3.1, 4.7, 2.2, 5.9, 4.4, 3.8, 12.5, 4.1, 3.3, 4.9, 2.7, 5.2};
const std::vector<double> kB{2.9, 3.6, 2.5, 4.8, 3.1, 3.9, 4.0, -6.0, 3.2, 3.7, 2.1, 4.6};

/// ttest_ind(equal_var=False, trim=...) of SciPy 1.10.1.
TEST(TrimmedTestsTest, DifferentPeopleAgreeWithScipy) {
  const std::vector<double> b(kB.begin(), kB.end() - 1);
  const auto two = yuen_test(kA, b, 0.2, Tail::kTwoSided);
  ASSERT_TRUE(two);
  EXPECT_NEAR(two->t, 1.9048098643285691, 1e-12);
  EXPECT_NEAR(two->p, 0.08023971943605779, 1e-12);
  const auto greater = yuen_test(kA, b, 0.1, Tail::kGreater);
  EXPECT_NEAR(greater->t, 2.058224573277617, 1e-12);
  EXPECT_NEAR(greater->p, 0.028419547297994164, 1e-12);
}

/// Wilcox' formula, computed with R's mean(trim), var and cov.
TEST(TrimmedTestsTest, PairsAgreeWithR) {
  const auto test = paired_yuen_test(kA, kB, 0.2, Tail::kTwoSided);
  ASSERT_TRUE(test);
  EXPECT_NEAR(test->difference, 0.825, 1e-12);
  EXPECT_NEAR(test->t, 3.3831857687609, 1e-10);
  EXPECT_EQ(test->df, 7.0);
  EXPECT_NEAR(test->p, 0.0117077038426, 1e-10);
  EXPECT_NEAR(test->low, 0.2483792818659, 1e-10);
  EXPECT_NEAR(test->high, 1.4016207181341, 1e-10);
}

TEST(TrimmedTestsTest, WithoutTrimmingTheyAreTheTestsOfMeans) {
  EXPECT_NEAR(yuen_test(kA, kB, 0.0, Tail::kLess)->p, welch_t_test(kA, kB, Tail::kLess)->p, 1e-12);
  EXPECT_NEAR(paired_yuen_test(kA, kB, 0.0, Tail::kLess)->p, paired_t_test(kA, kB, Tail::kLess)->p,
              1e-12);
}

TEST(TrimmedTestsTest, WhatIsNotDefinedSaysWhy) {
  const std::vector<double> few{1.0, 2.0, 3.0};
  EXPECT_EQ(yuen_test(few, kA, 0.4, Tail::kLess).because(),
            "trimming leaves fewer than two values");
  const std::vector<double> equal(12, 1.0);
  EXPECT_FALSE(yuen_test(equal, equal, 0.2, Tail::kLess));
  EXPECT_FALSE(paired_yuen_test(kA, kA, 0.2, Tail::kLess));
}

/// Two one-sided t.test() of R with mu = -bound and mu = bound, and its 90 % interval.
TEST(TestsOfEquivalence, AgreesWithR) {
  const EquivalenceTest pairs = equivalence_test(*paired_t_test(kA, kB, Tail::kTwoSided), 3.0);
  EXPECT_NEAR(pairs.p, 0.176421557102, 1e-10);
  EXPECT_NEAR(pairs.low, 0.243808865361, 1e-10);
  EXPECT_NEAR(pairs.high, 3.822857801306, 1e-10);
  const EquivalenceTest people = equivalence_test(*welch_t_test(kA, kB, Tail::kTwoSided), 2.5);
  EXPECT_NEAR(people.p, 0.3416123021078, 1e-10);
  EXPECT_NEAR(people.low, 0.0952747944953, 1e-10);
  EXPECT_NEAR(people.high, 3.9713918721713, 1e-10);
}

/// 2,000 studies of twelve people: of values with heavy tails (Student's t, 3 degrees of freedom)
/// without an effect, and of normal values whose difference is the bound.
TEST(TestsOfEquivalence, LevelsAreKept) {
  constexpr int kStudies = 2000, kPeople = 12;
  RandomStream random(1, "levels of tests beside");
  const auto heavy = [&random] {
    const double a = random.normal(), b = random.normal(), c = random.normal();
    return random.normal() / std::sqrt((a * a + b * b + c * c) / 3.0);
  };
  int different = 0, paired = 0, equivalent = 0;
  for (int study = 0; study < kStudies; ++study) {
    std::vector<double> a, b, others, shifted;
    for (int i = 0; i < kPeople; ++i) {
      const double person = random.normal();
      a.push_back(person + heavy());
      b.push_back(person + heavy());
      others.push_back(random.normal() + heavy());
      shifted.push_back(a.back() + 1.0 + random.normal());
    }
    different += yuen_test(a, others, 0.2, Tail::kTwoSided)->p < 0.05;
    paired += paired_yuen_test(a, b, 0.2, Tail::kTwoSided)->p < 0.05;
    equivalent += equivalence_test(*paired_t_test(shifted, a, Tail::kTwoSided), 1.0).p < 0.05;
  }
  constexpr int kMost = 130;  // 99.9 % of 2,000 studies at 5 %
  EXPECT_LE(different, kMost);
  EXPECT_LE(paired, kMost);
  EXPECT_LE(equivalent, kMost);
  EXPECT_GE(equivalent, 70) << "it is not blind";
  RecordProperty("different", different);
  RecordProperty("paired", paired);
  RecordProperty("equivalent", equivalent);
}

struct Judged {
  double t, df, n;
  double two, less, greater;
};

/// ttest.tstat() of R's BayesFactor 0.9.12-4.4 with rscale = sqrt(2) / 2, and nullInterval for
/// directed tests; cases in which it approximates nothing.
constexpr Judged kJudged[] = {
    {2.2, 11, 12, 1.65605931, 0.112399462, 3.19971917},
    {0.3, 11, 12, 0.29882692, 0.23454233, 0.363111509},
    {-2.5, 19, 20, 2.70214516, 5.32594102, 0.0783493127},
    {5, 29, 30, 901.586491, 0.0419792279, 1803.131},
    {0, 99, 100, 0.110704638, 0.110704638, 0.110704638},
    {-1.1, 38, 10, 0.498316141, 0.830339181, 0.166293102},
    {3.1, 22, 6, 8.37423882, 0.120755104, 16.6277225},
    {1.7, 21, 120.0 / 23.0, 1.05441113, 0.178063396, 1.93075886},
};

TEST(BayesFactorTest, AgreesWithBayesFactorOfR) {
  for (const Judged& each : kJudged) {
    const auto of = [&](Tail tail) { return *bayes_factor(each.t, each.df, each.n, tail); };
    EXPECT_NEAR(of(Tail::kTwoSided) / each.two, 1.0, 1e-6) << each.t;
    EXPECT_NEAR(of(Tail::kLess) / each.less, 1.0, 1e-6) << each.t;
    EXPECT_NEAR(of(Tail::kGreater) / each.greater, 1.0, 1e-6) << each.t;
  }
}

/// Data without an effect favour one on average by 1, whatever is asked.
TEST(BayesFactorTest, ItsMeanWithoutAnEffectIsOne) {
  for (const Tail tail : {Tail::kTwoSided, Tail::kLess, Tail::kGreater}) {
    double mean = 0.0;
    constexpr double kStep = 0.05;
    for (double t = -60.0; t <= 60.0; t += kStep) {
      mean += kStep * gsl_ran_tdist_pdf(t, 15.0) * *bayes_factor(t, 15.0, 16.0, tail);
    }
    // The rest is the share of the prior with effects above 15.
    EXPECT_NEAR(mean, 1.0, 0.05);
    EXPECT_LT(mean, 1.0);
  }
}

TEST(BayesFactorTest, LargeEffectsDoNotOverflow) {
  EXPECT_GT(*bayes_factor(300.0, 15.0, 16.0, Tail::kTwoSided), 1e20);
  EXPECT_LT(*bayes_factor(300.0, 15.0, 16.0, Tail::kLess), 0.1);
}

}  // namespace
}  // namespace haptrial::analysis
