// The tests that a design calls for, against the procedures called by hand.
#include "analysis/statistics/design/design_tests.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "analysis/statistics/base/p_adjust.h"
#include "analysis/statistics/design/design_json.h"
#include "analysis/statistics/design/design_lines.h"
#include "analysis/statistics/design/wording.h"
#include "analysis/statistics/variance/anova.h"
#include "analysis/statistics/variance/repeated_anova.h"
#include "core/base/error.h"
#include "core/base/random.h"
#include "tests/support/message_of.h"
#include "tests/support/two_factors.h"

namespace haptrial::analysis {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

constexpr Resampling kNone{1, "", 0, 1};

/// Values of participants in cells, one or two for each cell, from a named stream.
class Made {
 public:
  explicit Made(const char* stream) : random_(5, stream) {}

  /// @returns the mean of the cell
  double add(const std::string& subject, const std::vector<std::string>& levels, double mean) {
    const double a = mean + random_.normal();
    const double b = mean + random_.normal();
    observations.push_back({subject, levels, a});
    observations.push_back({subject, levels, b});
    return a + 0.5 * (b - a);
  }

  std::vector<Observation> observations;

 private:
  RandomStream random_;
};

std::string person(const char* group, int i) { return group + std::to_string(10 + i); }

void expect_effect(const Defined<EffectTest>& found, const std::string& factor, double f,
                   double p) {
  ASSERT_TRUE(found);
  EXPECT_EQ(found->factor, factor);
  EXPECT_NEAR(found->f, f, 1e-10 * f);
  EXPECT_NEAR(found->p, p, 1e-10);
}

TEST(DesignTable, TwoConditionsOfOneNameAreRefused) {
  const std::vector<Observation> clash{{"P1", {"a", "b, c"}, 1.0}, {"P1", {"a, b", "c"}, 2.0}};
  const std::vector<std::string> factors{"f", "g"};
  EXPECT_THROW(design_table(clash, factors), InputError);
}

TEST(DesignTable, FindsWhatVariesWithinAndBetween) {
  Made made("table");
  for (int i = 0; i < 3; ++i) {
    for (const char* level : {"slow", "fast"}) {
      made.add(person("N", i), {"novice", level}, 1.0);
      made.add(person("E", i), {"expert", level}, 2.0);
    }
  }
  const DesignTable table = design_table(made.observations, {"group", "speed"}, {"slow"});
  EXPECT_FALSE(table.factors[0].within);
  EXPECT_TRUE(table.factors[1].within);
  EXPECT_THAT(table.names,
              ElementsAre("expert, slow", "expert, fast", "novice, slow", "novice, fast"));
  EXPECT_EQ(table.participants(0), 3u);
  EXPECT_EQ(table.counts[0], 6u);
  EXPECT_EQ(table.complete().size(), 6u);
  EXPECT_TRUE(table.crossed);
}

TEST(DesignTable, LevelsThatAreNumbersStandInTheirOrder) {
  Made made("numbers");
  for (const char* level : {"10", "assisted", "2", "-0.5", "100", "0.03"}) {
    made.add("P1", {level}, 0.0);
  }
  EXPECT_THAT(design_table(made.observations, {"level"}).factors[0].levels,
              ElementsAre("-0.5", "0.03", "2", "10", "100", "assisted"));
}

TEST(DesignTable, WhoLacksACellOfTheirOwnLevelsIsIncomplete) {
  Made made("incomplete");
  for (int i = 0; i < 3; ++i) {
    made.add(person("N", i), {"novice", "slow"}, 1.0);
    made.add(person("E", i), {"expert", "slow"}, 1.0);
    made.add(person("E", i), {"expert", "fast"}, 1.0);
    if (i > 0) {
      made.add(person("N", i), {"novice", "fast"}, 1.0);
    }
  }
  const DesignTable table = design_table(made.observations, {"group", "speed"});
  const DesignTests tests = design_tests(table, {}, kNone);
  EXPECT_THAT(tests.incomplete, ElementsAre("N10"));
}

TEST(DesignTests, SayWhoAloneMakesAFactorVaryWithin) {
  Made made("one wrong");
  for (int i = 0; i < 6; ++i) {
    made.add(person("S", i), {i < 3 ? "con" : "pat"}, 0.0);
  }
  made.add(person("S", 2), {"pat"}, 0.0);
  EXPECT_EQ(design_tests(design_table(made.observations, {"group"}), {}, kNone).design,
            "within participants: group (con, pat, as S12 has several)");
}

TEST(DesignTests, BetweenParticipantsTakesWelchAndComparesDifferentPeople) {
  Made made("between");
  std::vector<std::vector<double>> groups(3);
  const char* names[] = {"a", "b", "c"};
  for (int g = 0; g < 3; ++g) {
    for (int i = 0; i < 5 + g; ++i) {
      groups[static_cast<std::size_t>(g)].push_back(
          made.add(person(names[g], i), {names[g]}, 0.5 * g));
    }
  }
  const DesignTable table = design_table(made.observations, {"condition"});
  AnalysisPlan plan;
  plan.tests = {{"a", "c", Tail::kLess}};
  const DesignTests tests = design_tests(table, plan, {1, "", 999, 1});
  EXPECT_EQ(tests.design, "between participants: condition (a, b, c)");
  const auto welch = welch_anova(groups);
  ASSERT_EQ(tests.effects.size(), 1u);
  expect_effect(tests.effects[0], "condition", welch->f, welch->p);
  const double explained = welch->f * welch->df_between;
  EXPECT_NEAR(tests.effects[0]->size->value, explained / (explained + welch->df_within), 1e-12)
      << "of the F that is printed beside it";
  const SideTest& planned = tests.planned.tests[0];
  EXPECT_FALSE(planned.paired);
  EXPECT_EQ(planned.count_a, 5u);
  EXPECT_EQ(planned.count_b, 7u);
  EXPECT_NEAR(planned.t->p, welch_t_test(groups[0], groups[2], Tail::kLess)->p, 1e-12);
  EXPECT_NEAR(planned.ranks->p, mann_whitney(groups[0], groups[2], Tail::kLess)->p, 1e-12);
  EXPECT_TRUE(planned.permutation->exact);  // 792 arrangements
  EXPECT_EQ(planned.permutation->arrangements, 792u);
  EXPECT_LT(planned.bootstrap->low, planned.t->difference);
  EXPECT_GT(planned.bootstrap->high, planned.t->difference);
  ASSERT_EQ(tests.families.size(), 1u);
  EXPECT_EQ(tests.families[0].tests.size(), 3u);
}

TEST(DesignTests, GroupsOfPeopleAndConditionsWithinTakeTheMixedAnalysis) {
  Made made("mixed");
  std::vector<std::vector<std::vector<double>>> groups(2);
  for (int g = 0; g < 2; ++g) {
    for (int i = 0; i < 4 + 2 * g; ++i) {
      auto& row = groups[static_cast<std::size_t>(g)].emplace_back();
      for (const char* level : {"x", "y", "z"}) {
        row.push_back(made.add(person(g == 0 ? "E" : "N", i), {level, g == 0 ? "expert" : "novice"},
                               g + (level[0] == 'z' ? 1.0 : 0.0)));
      }
    }
  }
  // The factor within comes first here: which is which is found, not given.
  const DesignTable table = design_table(made.observations, {"condition", "group"});
  const DesignTests tests = design_tests(table, {}, kNone);
  const auto mixed = test::mixed_factors(groups);
  ASSERT_EQ(tests.effects.size(), 3u);
  expect_effect(tests.effects[0], "group", mixed.a->f, mixed.a->p);
  expect_effect(tests.effects[1], "condition", mixed.b->f, mixed.b->p_greenhouse_geisser);
  expect_effect(tests.effects[2], "group × condition", mixed.interaction->f,
                mixed.interaction->p_greenhouse_geisser);
  // x-y, x-z, y-z; expert-novice; and cells: 3 pairs in each of 2 groups, 3 between groups.
  ASSERT_EQ(tests.families.size(), 3u);
  EXPECT_EQ(tests.families[0].tests.size(), 3u);
  EXPECT_EQ(tests.families[1].tests.size(), 1u);
  EXPECT_EQ(tests.families[2].tests.size(), 9u);
  EXPECT_TRUE(tests.families[0].tests[0].paired);
  EXPECT_FALSE(tests.families[1].tests[0].paired);
}

TEST(DesignTests, TwoFactorsWithinTakeTheTwoWayAnalysis) {
  Made made("two within");
  std::vector<std::vector<double>> rows;
  for (int i = 0; i < 7; ++i) {
    auto& row = rows.emplace_back();
    for (const char* a : {"now", "soon"}) {
      for (const char* b : {"x", "y", "z"}) {
        row.push_back(made.add(person("P", i), {a, b}, b[0] == 'z' ? 1.0 : 0.0));
      }
    }
  }
  const DesignTable table = design_table(made.observations, {"delay", "shape"});
  AnalysisPlan plan;
  plan.tests = {{"x", "z", Tail::kLess}, {"now, x", "soon, x", Tail::kTwoSided}};
  const DesignTests tests = design_tests(table, plan, kNone);
  const auto both = test::two_within(rows, 2);
  ASSERT_EQ(tests.effects.size(), 3u);
  expect_effect(tests.effects[0], "delay", both.a->f, both.a->p_greenhouse_geisser);
  expect_effect(tests.effects[1], "shape", both.b->f, both.b->p_greenhouse_geisser);
  expect_effect(tests.effects[2], "delay × shape", both.interaction->f,
                both.interaction->p_greenhouse_geisser);
  std::vector<double> x, z;  // a level is the mean of its cells
  for (const auto& row : rows) {
    x.push_back(0.5 * (row[0] + row[3]));
    z.push_back(0.5 * (row[2] + row[5]));
  }
  EXPECT_NEAR(tests.planned.tests[0].t->t, paired_t_test(x, z, Tail::kLess)->t, 1e-9);
  EXPECT_EQ(tests.planned.tests[1].t->df, 6.0);
  const std::vector<double> p{tests.planned.tests[0].t->p, tests.planned.tests[1].t->p};
  EXPECT_EQ(*tests.planned.tests[0].holm, holm_adjusted(p)[0]);
}

TEST(DesignTests, TwoFactorsBetweenTakeTheTwoWayAnalysis) {
  Made made("two between");
  std::vector<std::vector<double>> cells;
  int count = 3;
  for (const char* a : {"now", "soon"}) {
    for (const char* b : {"x", "y"}) {
      auto& cell = cells.emplace_back();
      for (int i = 0; i < count; ++i) {
        cell.push_back(made.add(std::string(a) + b + std::to_string(i), {a, b}, 0.0));
      }
      ++count;
    }
  }
  const DesignTests tests =
      design_tests(design_table(made.observations, {"delay", "shape"}), {}, kNone);
  const auto both = test::two_between(cells, 2);
  ASSERT_EQ(tests.effects.size(), 3u);
  expect_effect(tests.effects[1], "shape", both.b->f, both.b->p);
}

TEST(DesignTests, LevelsAcrossUnequalGroupsAreWeighedAlike) {
  // x is 1 above y in each group, but the groups differ by 10 and have x and y in unequal numbers:
  // pooled people would have x below y.
  Made made("confounded");
  const auto add = [&](const char* level, const char* group, int count, double mean) {
    for (int i = 0; i < count; ++i) {
      made.add(fmt::format("{}{}{}", level, group, i), {level, group}, mean);
    }
  };
  add("x", "low", 9, 1.0);
  add("y", "low", 3, 0.0);
  add("x", "high", 3, 11.0);
  add("y", "high", 9, 10.0);
  AnalysisPlan plan;
  plan.tests = {{"x", "y", Tail::kGreater}};
  const DesignTests tests =
      design_tests(design_table(made.observations, {"level", "group"}), plan, kNone);
  const SideTest& test = tests.planned.tests[0];
  EXPECT_NEAR(test.t->difference, 1.0, 1.2);
  EXPECT_GT(test.t->difference, 0.0);
  EXPECT_LT(test.t->error, 1.0);
  EXPECT_THAT(test.ranks.because(), HasSubstr("other groups"));
}

TEST(DesignTests, WhatLiesBetweenOtherGroupsIsNoSpreadOfTheirPeople) {
  // Two sites that differ by 10 lie across the training: of equally large groups, the square of
  // d's t is F of the two-way analysis, and what takes people of both sites together says nothing.
  Made made("sites");
  for (int i = 0; i < 6; ++i) {
    made.add(person("A", i), {"trained", "north"}, 11.5);
    made.add(person("B", i), {"not", "north"}, 10.0);
    made.add(person("C", i), {"trained", "south"}, 1.5);
    made.add(person("D", i), {"not", "south"}, 0.0);
  }
  AnalysisPlan plan;
  plan.tests = {{"trained", "not", Tail::kTwoSided}};
  const DesignTests tests =
      design_tests(design_table(made.observations, {"training", "site"}), plan, {1, "s", 99, 1});
  const SideTest& test = tests.planned.tests[0];
  ASSERT_TRUE(test.size);
  const double t = test.size->value / std::sqrt(4.0 / 6.0 / 4.0);
  EXPECT_NEAR(t * t, tests.effects[0]->f, 1e-9 * t * t);
  EXPECT_GT(test.size->value, 1.0);
  EXPECT_GT(test.size->low, 0.0);
  for (const std::string& why :
       {test.ranks.because(), test.permutation.because(), test.bootstrap.because()}) {
    EXPECT_THAT(why, HasSubstr("other groups"));
  }
}

TEST(DesignTests, LevelsThatDifferInOtherFactorsAreNotCompared) {
  // Speed has no effect, load adds 3; fast and heavy never came together.
  Made made("missing cell");
  for (int i = 0; i < 8; ++i) {
    made.add(person("S", i), {"slow", "light"}, 0.0);
    made.add(person("S", i), {"slow", "heavy"}, 3.0);
    made.add(person("S", i), {"fast", "light"}, 0.0);
  }
  AnalysisPlan plan;
  plan.beside.bayes_factors = true;
  plan.tests = {{"fast", "slow", Tail::kLess}, {"fast, light", "slow, light", Tail::kLess}};
  const DesignTests tests =
      design_tests(design_table(made.observations, {"speed", "load"}), plan, kNone);
  const SideTest& levels = tests.planned.tests[0];
  EXPECT_THAT(levels.t.because(), HasSubstr("'fast' and 'slow' differ in other factors"));
  EXPECT_THAT(levels.bayes_factor.because(), HasSubstr("differ in other factors"));
  EXPECT_TRUE(tests.planned.tests[1].t);
  const auto lines = design_lines(design_table(made.observations, {"speed", "load"}), tests);
  EXPECT_EQ(
      std::ranges::count_if(
          lines, [](const std::string& line) { return line.find("differ in other") != line.npos; }),
      1);
}

TEST(DesignLines, TheRuleOfAStudyDecidesItsTest) {
  Made made("rule");
  for (int i = 0; i < 8; ++i) {
    made.add(person("S", i), {"a"}, 0.0);
    made.add(person("S", i), {"b"}, 3.0);
  }
  AnalysisPlan plan;
  plan.tests = {{"a", "b", Tail::kLess}};
  DesignTests tests = design_tests(design_table(made.observations, {"c"}), plan, kNone);
  EXPECT_THAT(planned_lines(tests).front(), HasSubstr("significant"));
  EXPECT_THAT(effect_lines(tests).front(), HasSubstr("Effect of c: significant; F("));
  EXPECT_THAT(design_json(tests), Not(HasSubstr("ends_by_rule")));
  tests.ends_by_rule = true;  // as the test of another quantity decides
  EXPECT_THAT(effect_lines(tests).front(), StartsWith("Effect of c: F("));
  EXPECT_THAT(effect_lines(tests).front(), HasSubstr("had been fixed"));
  EXPECT_THAT(design_json(tests), HasSubstr("\"ends_by_rule\": true"));
  EXPECT_THAT(planned_lines(tests).front(), HasSubstr("significant"));
  EXPECT_THAT(planned_lines(tests).front(), HasSubstr("had been fixed"));
  tests.sequential = SequentialResult{plan.tests.front(), {}, 20, {}, SequentialVerdict::kGoOn};
  EXPECT_THAT(planned_lines(tests).front(), HasSubstr("a < b: not decided yet"));
  EXPECT_THAT(planned_lines(tests).front(), HasSubstr("had been fixed"));
  tests.sequential->verdict = SequentialVerdict::kUndecided;
  EXPECT_THAT(planned_lines(tests).front(), HasSubstr("a < b: not shown"));
  tests.sequential->verdict = SequentialVerdict::kEffect;
  EXPECT_THAT(planned_lines(tests).front(), HasSubstr("a < b: significant"));
}

TEST(DesignTests, LevelsWithinAnotherAreCompared) {
  // A gain of guidance is of the trained alone: no gain is shared, and none can be held.
  Made made("nested");
  for (int i = 0; i < 5; ++i) {
    made.add(person("A", i), {"alone", "0"}, 0.0);
    made.add(person("B", i), {"guided", "1"}, 1.0);
    made.add(person("C", i), {"guided", "2"}, 1.0);
  }
  AnalysisPlan plan;
  plan.tests = {{"guided", "alone", Tail::kGreater}};
  const DesignTests tests =
      design_tests(design_table(made.observations, {"way", "gain"}), plan, kNone);
  ASSERT_TRUE(tests.planned.tests[0].t);
  EXPECT_EQ(tests.planned.tests[0].count_a, 10u);
}

TEST(DesignTests, StrataOfOneAreTheSimpleTests) {
  const std::vector<double> a{1.0, 4.0, 2.5, 3.0};
  const std::vector<double> b{2.0, 6.0, 5.5};
  const auto welch = welch_t_test(a, b, Tail::kLess);
  const auto one = stratified_t_test({a}, {b}, Tail::kLess);
  EXPECT_NEAR(one->t, welch->t, 1e-12);
  EXPECT_NEAR(one->df, welch->df, 1e-12);
  EXPECT_NEAR(one->p, welch->p, 1e-12);
  const auto d = cohens_d(a, b), stratum = stratified_d({a}, {b});
  EXPECT_NEAR(stratum->value, d->value, 1e-12);
  EXPECT_NEAR(stratum->low, d->low, 1e-9);
  EXPECT_NEAR(stratum->high, d->high, 1e-9);
}

TEST(DesignTests, WhoHasBothSidesIsCompared) {
  // Nobody has all three conditions; each pair has its own people.
  Made made("partly");
  for (int i = 0; i < 4; ++i) {
    made.add(person("A", i), {"c1"}, 0.0);
    made.add(person("A", i), {"c2"}, 0.0);
    made.add(person("B", i), {"c1"}, 0.0);
    made.add(person("B", i), {"c3"}, 0.0);
  }
  const DesignTests tests = design_tests(design_table(made.observations, {"c"}), {}, kNone);
  EXPECT_FALSE(tests.effects[0]);
  ASSERT_EQ(tests.families[0].tests.size(), 3u);
  EXPECT_TRUE(tests.families[0].tests[0].paired);
  EXPECT_EQ(tests.families[0].tests[0].count_a, 4u);
  EXPECT_FALSE(tests.families[0].tests[2].paired);  // c2 and c3: different people
}

TEST(DesignTests, AFactorOfOneLevelVariesNothing) {
  Made made("one level");
  for (int i = 0; i < 4; ++i) {
    made.add(person("A", i), {"expert", "all"}, 0.0);
    made.add(person("B", i), {"novice", "all"}, 1.0);
  }
  const DesignTests tests =
      design_tests(design_table(made.observations, {"group", "condition"}), {}, kNone);
  EXPECT_EQ(tests.design, "between participants: group (expert, novice)");
  ASSERT_TRUE(tests.effects[0]);
  EXPECT_EQ(tests.effects[0]->factor, "group");
  EXPECT_EQ(tests.families.size(), 1u);
}

TEST(DesignTests, AnExactPIsNeverAboveOne) {
  Made made("separated");
  for (int i = 0; i < 2; ++i) {
    made.observations.push_back({person("A", i), {"a"}, 11.0 + i});
    made.observations.push_back({person("B", i), {"b"}, 1.0 + i});
  }
  AnalysisPlan plan;
  plan.tests = {{"a", "b", Tail::kLess}};
  const DesignTests tests = design_tests(design_table(made.observations, {"c"}), plan, kNone);
  EXPECT_EQ(*tests.planned.tests[0].ranks_holm, 1.0);
}

TEST(DesignTests, CombinationsThatNobodyHadAreComparedTwoByTwo) {
  Made made("hole");
  for (int i = 0; i < 4; ++i) {
    made.add(person("P", i), {"now", "x"}, 0.0);
    made.add(person("P", i), {"now", "y"}, 0.0);
    made.add(person("P", i), {"soon", "x"}, 0.0);
  }
  const DesignTests tests =
      design_tests(design_table(made.observations, {"delay", "shape"}), {}, kNone);
  ASSERT_EQ(tests.effects.size(), 1u);
  EXPECT_THAT(tests.effects[0].because(), HasSubstr("combinations"));
  ASSERT_EQ(tests.families.size(), 1u);
  EXPECT_EQ(tests.families[0].tests.size(), 2u);
  EXPECT_TRUE(tests.incomplete.empty());
}

TEST(DesignTests, OfNothingOrOfOneConditionAreNotDefined) {
  EXPECT_FALSE(design_tests(design_table({}, {"condition"}), {}, kNone).effects[0]);
  Made made("one");
  made.add("P1", {"a"}, 0.0);
  made.add("P2", {"a"}, 0.0);
  const DesignTests tests = design_tests(design_table(made.observations, {"condition"}), {}, kNone);
  EXPECT_THAT(tests.effects[0].because(), HasSubstr("fewer than two conditions"));
  EXPECT_TRUE(tests.families.empty());
}

PlannedTest test_of(const std::string& text) {
  return parse_analysis_plan({text}, "", "--planned").tests.at(0);
}

/// Three conditions, of which the last lies apart; the plan compares the first two.
TEST(DesignLines, SayWhatATestCannotExcludeAndWhatWasNotPlanned) {
  Made made("lines");
  for (int i = 0; i < 12; ++i) {
    for (const char* level : {"a", "b", "c"}) {
      made.add(person("P", i), {level}, level[0] == 'c' ? 5.0 : 0.0);
    }
  }
  AnalysisPlan plan;
  plan.tests = {test_of("a < b"), test_of("b < c")};
  const DesignTests tests = design_tests(design_table(made.observations, {"k"}), plan, kNone);
  EXPECT_THAT(effect_lines(tests).at(0), testing::StartsWith("Effect of k: significant; F("));
  const auto planned = planned_lines(tests);
  const TTest& t = *tests.planned.tests[0].t;
  EXPECT_THAT(planned.at(0),
              testing::StartsWith("Planned, a < b: not shown, and differences up to " +
                                  number(std::max(-t.low, t.high)) +
                                  " are compatible with the data; difference "));
  EXPECT_THAT(planned.at(1), HasSubstr(" (two-sided, not adjusted), paired t(11) = "));
  ASSERT_EQ(unplanned_lines(tests).size(), 1u);
  EXPECT_THAT(unplanned_lines(tests)[0],
              testing::StartsWith("Not planned, a and c: significant; difference "));
  DesignTests by_rule = tests;
  by_rule.ends_by_rule = true;
  EXPECT_THAT(unplanned_lines(by_rule)[0], HasSubstr("had been fixed"));
}

// Holm's rule over two tests: the smaller p doubled, the larger at least as large.
TEST(DesignTests, AreNamedWithThePThatDecides) {
  Made made("named");
  for (int i = 0; i < 8; ++i) {
    for (const char* level : {"a", "b", "c"}) {
      made.add(person("P", i), {level}, level[0] == 'c' ? 1.0 : 0.0);
    }
  }
  AnalysisPlan plan;
  plan.tests = {test_of("a < b"), test_of("b < c")};
  const TestFamily planned =
      design_tests(design_table(made.observations, {"condition"}), plan, kNone).planned;
  const auto named = named_tests(planned, "planned: ");
  std::map<std::string, double> p;
  for (const NamedTest& test : named) {
    p[test.name] = test.p;
  }
  const double first = p.at("planned: a < b, paired t, unadjusted");
  const double second = p.at("planned: b < c, paired t, unadjusted");
  EXPECT_EQ(first, planned.tests[0].t->p);
  EXPECT_NEAR(std::min(p.at("planned: a < b, paired t"), p.at("planned: b < c, paired t")),
              2.0 * std::min(first, second), 1e-15);
  EXPECT_EQ(named.size(), 8u);  // t and ranks of two tests, with and without Holm's adjustment
  const TestFamily one{"planned", {planned.tests[0]}};
  EXPECT_EQ(named_tests(one, "").size(), 2u) << "nothing to adjust";
}

TEST(AnalysisPlan, IsReadAndWrittenAlike) {
  for (const char* text : {"visual < haptic", "a b > c", "x, y != x, z"}) {
    EXPECT_EQ(text_of(test_of(text)), text);
  }
  EXPECT_EQ(text_of(test_of(" a<b ")), "a < b");
  for (const char* text : {"", "a", "a < ", " < b", "a < a", "a < b < c", "a < b != c", "a = b"}) {
    EXPECT_THROW(test_of(text), InputError) << text;
  }
  EXPECT_EQ(parse_analysis_plan({}, "a", "--planned").reference, "a");
}

/// A level such as "<50 ms" has a sign of its own; the sign between blanks divides the sides.
TEST(AnalysisPlan, LevelsMayHaveSigns) {
  const PlannedTest test = test_of("<50 ms != >90 ms");
  EXPECT_EQ(test.a, "<50 ms");
  EXPECT_EQ(test.b, ">90 ms");
  EXPECT_EQ(test.tail, Tail::kTwoSided);
  EXPECT_EQ(test_of("<50 ms < 50 ms").a, "<50 ms");
  EXPECT_EQ(test_of("a<b").b, "b") << "a sign without blanks, where it is the only one";
}

TEST(AnalysisPlan, APairStatedTwiceIsFoundWhateverItsDirection) {
  EXPECT_EQ(parse_analysis_plan({"a < b", "b < c"}, "", "--planned").tests.size(), 2U);
  EXPECT_EQ(test::message_of([] {
              parse_analysis_plan({"a < b", "b > a"}, "", "--planned");
            }),
            "--planned compares a and b twice; state each pair once");
}

TEST(AnalysisPlan, NamesWithoutTrialsAreRefusedWithTheKnownOnes) {
  Made made("plan");
  for (int i = 0; i < 3; ++i) {
    made.add(person("P", i), {"now", "x"}, 0.0);
    made.add(person("P", i), {"soon", "x"}, 0.0);
    made.add(person("P", i), {"now", "now"}, 0.0);
    made.add(person("P", i), {"soon", "now"}, 0.0);
  }
  const DesignTable table = design_table(made.observations, {"delay", "shape"});
  const auto problem = [&](const AnalysisPlan& plan) {
    try {
      check_plan(table, plan);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(problem({{{"soon", "x", Tail::kLess}}, ""}),
            "the planned test \"soon < x\" compares trials with themselves");
  EXPECT_THAT(problem({{{"sone", "x", Tail::kLess}}, ""}),
              HasSubstr("names 'sone', which the data do not have; allowed: 'now, now'"));
  EXPECT_THAT(problem({{{"now", "soon", Tail::kLess}}, ""}), HasSubstr("several factors"));
  EXPECT_THAT(problem({{}, "late"}), HasSubstr("the reference condition names 'late'"));
  EXPECT_EQ(problem({{{"now, x", "soon, x", Tail::kLess}}, ""}), "");
}

}  // namespace
}  // namespace haptrial::analysis
