// Two-way repeated-measures and mixed analyses of variance against simpler tests that they contain,
// and designs of several factors against R.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <utility>

#include "analysis/statistics/tests/t_tests.h"
#include "analysis/statistics/variance/multifactor_anova.h"
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

/// Numbers that look like chance and can be written in any language.
double scattered(int i) { return (i * 7919 % 101) / 10.0; }

std::string name_of(const MultifactorEffect& effect) {
  std::string name;
  for (const std::size_t f : effect.between) {
    name += static_cast<char>('G' + static_cast<char>(f));
  }
  for (const std::size_t f : effect.within) {
    name += static_cast<char>('A' + static_cast<char>(f));
  }
  return name;
}

std::map<std::string, WithinEffect> effects_of(const MultifactorTable& table) {
  std::map<std::string, WithinEffect> effects;
  for (const MultifactorEffect& effect : multifactor_anova(table)) {
    EXPECT_TRUE(effect.test) << name_of(effect);
    effects[name_of(effect)] = *effect.test;
  }
  return effects;
}

/// Six participants; aov(y ~ A * B * C + Error(S / (A * B * C))) of R.
TEST(MultifactorAnovaTest, ThreeFactorsWithinAgreeWithR) {
  MultifactorTable table{{2, 3, 2}, {}, {}, std::vector<std::vector<std::size_t>>(6)};
  for (int s = 0; s < 6; ++s) {
    auto& row = table.values.emplace_back();
    for (int cell = 0; cell < 12; ++cell) {
      const int a = cell / 6, b = cell / 2 % 3, c = cell % 2;
      const int i = ((s * 2 + a) * 3 + b) * 2 + c;
      row.push_back(scattered(i) + 1.5 * (a + 1) + (b == 2 ? 2.0 : 0.0) + 3.0 * (s + 1));
    }
  }
  auto found = effects_of(table);
  ASSERT_EQ(found.size(), 7u);
  const std::map<std::string, std::pair<double, double>> judged{
      {"A", {15.8111949809, 0.0105692937}},  {"B", {4.5771359314, 0.0387857116}},
      {"C", {1.2008626605, 0.3231034613}},   {"AB", {0.4545454545, 0.6472278485}},
      {"AC", {0.2941176471, 0.6108811834}},  {"BC", {0.4545454545, 0.6472278485}},
      {"ABC", {0.3465346535, 0.7152997800}},
  };
  for (const auto& [name, f_and_p] : judged) {
    EXPECT_NEAR(found[name].f, f_and_p.first, 1e-9) << name;
    EXPECT_NEAR(found[name].p, f_and_p.second, 1e-9) << name;
  }
}

/// Eleven participants in four groups of different size; Anova(type = 3) of R's car.
TEST(MultifactorAnovaTest, TwoFactorsBetweenAndOneWithinAgreeWithCar) {
  const std::vector<std::size_t> g{0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 1};
  const std::vector<std::size_t> h{0, 0, 1, 1, 0, 0, 0, 1, 1, 1, 1};
  MultifactorTable table{{3}, {2, 2}, {}, {}};
  for (int s = 0; s < 11; ++s) {
    const auto at = static_cast<std::size_t>(s);
    table.groups.push_back({g[at], h[at]});
    auto& row = table.values.emplace_back();
    for (int w = 0; w < 3; ++w) {
      row.push_back(scattered(s * 3 + w) + 2.0 * (static_cast<double>(g[at]) + 1.0) +
                    (w + 1) * (static_cast<double>(h[at]) + 1.0));
    }
  }
  auto found = effects_of(table);
  ASSERT_EQ(found.size(), 7u);
  const std::map<std::string, double> judged{
      {"G", 32.3217342110}, {"H", 24.4398746397}, {"GH", 0.0030172685}, {"A", 2.3752521683},
      {"GA", 0.1983805668}, {"HA", 0.2270845876}, {"GHA", 0.1983805668}};
  for (const auto& [name, f] : judged) {
    EXPECT_NEAR(found[name].f, f, 1e-8) << name;
  }
  EXPECT_NEAR(found["A"].p, 0.1293617, 1e-6);
  EXPECT_EQ(found["A"].df_error, 14.0);
  EXPECT_EQ(found["G"].df_error, 7.0);
}

/// 2,000 studies of people who do not differ: two groups of five and seven, 2 x 3 conditions.
TEST(MultifactorAnovaTest, EveryEffectKeepsItsLevel) {
  constexpr int kStudies = 2000;
  std::map<std::string, int> found;
  RandomStream random(1, "null");
  for (int study = 0; study < kStudies; ++study) {
    MultifactorTable table{{2, 3}, {2}, {}, {}};
    for (std::size_t s = 0; s < 12; ++s) {
      table.groups.push_back({s < 5 ? std::size_t{0} : std::size_t{1}});
      auto& row = table.values.emplace_back();
      const double person = 2.0 * random.normal();
      for (int cell = 0; cell < 6; ++cell) {
        row.push_back(person + random.normal());
      }
    }
    for (const auto& [name, effect] : effects_of(table)) {
      found[name] += effect.p < 0.05 ? 1 : 0;
    }
  }
  EXPECT_EQ(found.size(), 7u);
  for (const auto& [name, count] : found) {
    EXPECT_NEAR(count, 100, 35) << name;  // 3.6 standard deviations
  }
}

TEST(MultifactorAnovaTest, WhatIsNotDefinedSaysWhy) {
  MultifactorTable alone{
      {2}, {2, 2}, {{1, 2}, {3, 5}, {2, 9}, {4, 4}}, {{0, 0}, {0, 1}, {1, 0}, {1, 1}}};
  EXPECT_THAT(multifactor_anova(alone)[0].test.because(), testing::HasSubstr("one participant"));
  alone.groups[3] = {1, 0};
  EXPECT_THAT(multifactor_anova(alone)[0].test.because(), testing::HasSubstr("no participant"));
}

}  // namespace
}  // namespace haptrial::analysis::designs_test
