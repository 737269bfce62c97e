// Two-way repeated-measures and mixed analyses of variance against simpler tests that they contain.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/statistics/tests/t_tests.h"
#include "analysis/statistics/variance/repeated_anova.h"
#include "core/base/random.h"
#include "tests/support/two_factors.h"

namespace haptrial::analysis::designs_test {
namespace {

using testing::HasSubstr;
using Values = std::vector<double>;
using Table = std::vector<Values>;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Table drawn(RandomStream& random, std::size_t rows, std::size_t columns) {
  Table table(rows, Values(columns));
  for (auto& row : table) {
    const double participant = 3.0 * random.normal();
    for (auto& value : row) {
      value = participant + random.normal();
    }
  }
  return table;
}

TEST(TwoFactorsWithin, HasTheOneWayAnalysisOfEachFactorsMeans) {
  RandomStream random(71, "margins");
  const Table table = drawn(random, 8, 12);  // 3 levels of a, 4 of b
  Table over_b(8, Values(3, 0.0)), over_a(8, Values(4, 0.0));
  for (std::size_t i = 0; i < 8; ++i) {
    for (std::size_t j = 0; j < 12; ++j) {
      over_b[i][j / 4] += table[i][j] / 4.0;
      over_a[i][j % 4] += table[i][j] / 3.0;
    }
  }
  const auto both = test::two_within(table, 3);
  const auto a = repeated_measures_anova(over_b);
  const auto b = repeated_measures_anova(over_a);
  EXPECT_NEAR(both.a->f, a->f, 1e-11 * a->f);
  EXPECT_NEAR(both.a->squares, 4.0 * a->squares_condition, 1e-11);
  EXPECT_NEAR(both.a->sphericity.mauchly->p, a->sphericity.mauchly->p, 1e-12);
  EXPECT_NEAR(both.b->f, b->f, 1e-11 * b->f);
  EXPECT_NEAR(*both.b->p_huynh_feldt, *b->p_huynh_feldt, 1e-12);
  EXPECT_EQ(both.interaction->df, 6.0);
  EXPECT_EQ(both.interaction->df_error, 42.0);
}

TEST(TwoFactorsWithin, OfTwoByTwoIsThePairedTOfTheDifferences) {
  RandomStream random(72, "two by two");
  const Table table = drawn(random, 9, 4);
  Values first, second;
  for (const auto& row : table) {
    first.push_back(row[0] - row[1]);
    second.push_back(row[2] - row[3]);
  }
  const auto anova = test::two_within(table, 2);
  const auto t = paired_t_test(first, second, Tail::kTwoSided);
  EXPECT_NEAR(anova.interaction->f, t->t * t->t, 1e-11 * (1.0 + t->t * t->t));
  EXPECT_NEAR(anova.interaction->p, t->p, 1e-12);
  EXPECT_THAT(anova.interaction->sphericity.mauchly.because(), HasSubstr("single difference"));
}

// Squares of the effects, of participants and of the errors add up to those of all values.
TEST(TwoFactorsWithin, TakesTheSquaresApart) {
  RandomStream random(73, "parts");
  const Table table = drawn(random, 5, 6);
  double mean = 0.0, total = 0.0;
  Values participants(5, 0.0);
  for (std::size_t i = 0; i < 5; ++i) {
    for (const double value : table[i]) {
      mean += value / 30.0;
      participants[i] += value / 6.0;
    }
  }
  for (const auto& row : table) {
    for (const double value : row) {
      total += (value - mean) * (value - mean);
    }
  }
  double parts = 0.0;
  for (const double participant : participants) {
    parts += 6.0 * (participant - mean) * (participant - mean);
  }
  const auto anova = test::two_within(table, 3);
  for (const auto* effect : {&anova.a, &anova.b, &anova.interaction}) {
    parts += (*effect)->squares + (*effect)->squares_error;
  }
  EXPECT_NEAR(parts, total, 1e-12 * total);
}

TEST(TwoFactorsWithin, SaysWhyAnEffectIsNotDefined) {
  // b differs by 2 for everyone; a does not.
  const auto anova = test::two_within({{1, 3, 5, 7}, {2, 4, 3, 5}, {0, 2, 9, 11}}, 2);
  EXPECT_TRUE(anova.a);
  EXPECT_THAT(anova.b.because(), HasSubstr("same amount"));
  EXPECT_THAT(anova.interaction.because(), HasSubstr("same amount"));
  EXPECT_THAT(test::two_within({{1, 2, 3, 4}}, 2).a.because(), HasSubstr("two participants"));
}

TEST(Sphericity, HoldsWhereContrastsVaryAlike) {
  const auto s = sphericity(7.0 * Eigen::MatrixXd::Identity(3, 3), 10.0);
  EXPECT_DOUBLE_EQ(s.mauchly->w, 1.0);
  EXPECT_DOUBLE_EQ(s.mauchly->p, 1.0);
  EXPECT_DOUBLE_EQ(s.greenhouse_geisser, 1.0);
  EXPECT_GT(*s.huynh_feldt, 1.0);
}

TEST(Sphericity, OfTwoContrastsHasAClosedForm) {
  // Variances 1 and 4: W = 4 / 2.5², epsilon = 25 / (2 17).
  Eigen::MatrixXd products = Eigen::MatrixXd::Zero(2, 2);
  products.diagonal() << 1.0, 4.0;
  const auto s = sphericity(products, 8.0);
  EXPECT_DOUBLE_EQ(s.mauchly->w, 0.64);
  EXPECT_DOUBLE_EQ(s.greenhouse_geisser, 25.0 / 34.0);
  EXPECT_DOUBLE_EQ(*s.huynh_feldt, (9.0 * 25.0 / 17.0 - 2.0) / (2.0 * (8.0 - 25.0 / 17.0)));
  // p of chi squared with two degrees of freedom; the second term of the expansion is 0.
  const double rho = 1.0 - 12.0 / 96.0;
  EXPECT_NEAR(s.mauchly->p, std::pow(0.64, 8.0 * rho / 2.0), 1e-14);
}

// The contrasts are one choice of many: a rotation of them changes nothing. (Given all conditions,
// mauchly.test of R 4.2 lets the p depend on how many there are beside the contrasts.)
TEST(Sphericity, DoesNotDependOnTheChoiceOfContrasts) {
  RandomStream random(74, "rotation");
  Table table = drawn(random, 9, 4);
  const auto plain = repeated_measures_anova(table);
  for (auto& row : table) {
    row = {row[2], row[0], row[3], row[1]};
  }
  const auto turned = repeated_measures_anova(table);
  EXPECT_NEAR(turned->sphericity.mauchly->w, plain->sphericity.mauchly->w, 1e-13);
  EXPECT_NEAR(turned->sphericity.mauchly->p, plain->sphericity.mauchly->p, 1e-13);
  EXPECT_NEAR(turned->epsilon, plain->epsilon, 1e-13);
}

TEST(Sphericity, IsRejectedAsOftenAsItSays) {
  RandomStream random(75, "spherical");
  int rejected = 0;
  constexpr int kRepeats = 4000;
  for (int i = 0; i < kRepeats; ++i) {
    rejected += repeated_measures_anova(drawn(random, 12, 4))->sphericity.mauchly->p < 0.05 ? 1 : 0;
  }
  EXPECT_NEAR(rejected, 0.05 * kRepeats, 4.0 * std::sqrt(0.05 * 0.95 * kRepeats));
}

TEST(Sphericity, SaysWhyItIsNotDefined) {
  RandomStream random(76, "few");
  const auto few = repeated_measures_anova(drawn(random, 3, 4));
  EXPECT_THAT(few->sphericity.mauchly.because(), HasSubstr("too few participants"));
  const auto two = repeated_measures_anova(drawn(random, 2, 4));
  EXPECT_THAT(two->sphericity.huynh_feldt.because(), HasSubstr("too few participants"));
  EXPECT_THAT(two->p_huynh_feldt.because(), HasSubstr("too few participants"));
  // The third condition is the mean of the others: two conditions' differences decide the third.
  Table dependent = drawn(random, 9, 3);
  for (auto& row : dependent) {
    row[2] = 0.5 * (row[0] + row[1]);
  }
  EXPECT_THAT(repeated_measures_anova(dependent)->sphericity.mauchly.because(),
              HasSubstr("follows from the others"));
}

TEST(MixedFactors, OfTwoGroupsAndTwoConditionsHasThreeTTests) {
  RandomStream random(77, "two groups");
  const std::vector<Table> groups{drawn(random, 5, 2), drawn(random, 8, 2)};
  Values means[2], differences[2];
  for (std::size_t g = 0; g < 2; ++g) {
    for (const auto& row : groups[g]) {
      means[g].push_back(0.5 * (row[0] + row[1]));
      differences[g].push_back(row[0] - row[1]);
    }
  }
  const auto anova = test::mixed_factors(groups);
  const auto between = student_t_test(means[0], means[1], Tail::kTwoSided);
  const auto interaction = student_t_test(differences[0], differences[1], Tail::kTwoSided);
  EXPECT_NEAR(anova.a->f, between->t * between->t, 1e-11);
  EXPECT_NEAR(anova.a->p, between->p, 1e-12);
  EXPECT_NEAR(anova.interaction->f, interaction->t * interaction->t, 1e-11);
  EXPECT_NEAR(anova.interaction->p, interaction->p, 1e-12);
}

TEST(MixedFactors, RejectsNoInteractionAsOftenAsItSays) {
  RandomStream random(79, "null mixed");
  int rejected = 0;
  constexpr int kRepeats = 4000;
  for (int i = 0; i < kRepeats; ++i) {
    const auto anova = test::mixed_factors({drawn(random, 4, 3), drawn(random, 7, 3)});
    rejected += anova.interaction->p < 0.05 ? 1 : 0;
  }
  EXPECT_NEAR(rejected, 0.05 * kRepeats, 4.0 * std::sqrt(0.05 * 0.95 * kRepeats));
}

TEST(MixedFactors, SaysWhyItIsNotDefined) {
  const Table a{{1, 2}, {3, 5}}, b{{4, 4}, {6, 9}};
  EXPECT_TRUE(test::mixed_factors({a, b}).a);
  EXPECT_TRUE(test::mixed_factors({a, {{4, 4}}}).a);  // one participant in a group is enough
  EXPECT_THAT(test::mixed_factors({a, {}}).a.because(), HasSubstr("no participant"));
  EXPECT_THAT(test::mixed_factors({{{1, 2}}, {{4, 4}}}).b.because(),
              HasSubstr("one participant in every group"));
  EXPECT_THAT(test::mixed_factors({a, {{4, kNan}}}).a.because(), HasSubstr("finite"));
  const auto alike = test::mixed_factors({{{1, 3}, {3, 1}}, {{2, 5}, {5, 2}}});
  EXPECT_THAT(alike.a.because(), HasSubstr("not vary"));
  EXPECT_TRUE(alike.b);
  const auto parallel = test::mixed_factors({{{1, 3}, {4, 6}}, {{2, 5}, {9, 12}}});
  EXPECT_TRUE(parallel.a);
  EXPECT_THAT(parallel.interaction.because(), HasSubstr("same amount"));
}

}  // namespace
}  // namespace haptrial::analysis::designs_test
