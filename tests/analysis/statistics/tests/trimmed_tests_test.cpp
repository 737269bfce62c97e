#include "analysis/statistics/tests/trimmed_tests.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/base/random.h"

namespace haptrial::analysis {
namespace {

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

}  // namespace
}  // namespace haptrial::analysis
