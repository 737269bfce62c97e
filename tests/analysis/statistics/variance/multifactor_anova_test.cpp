#include "analysis/statistics/variance/multifactor_anova.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <string>

#include "core/base/random.h"

namespace haptrial::analysis {
namespace {

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
}  // namespace haptrial::analysis
