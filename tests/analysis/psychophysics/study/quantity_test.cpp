#include "analysis/psychophysics/study/quantity.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "tests/support/message_of.h"

namespace haptrial::analysis::trials {
namespace {

/// The interval of values of participants under one condition.
MeanInterval interval_of(std::vector<double> each, ValueRange range) {
  std::vector<QuantityValue> values;
  for (const double value : each) {
    values.push_back({"P" + std::to_string(values.size()), {}, value});
  }
  return *quantity("q", "quantity", "", values, TrialsPlan{}, range).means.at(0);
}

/// Areas of three participants near 1: Student's interval of their mean would go beyond it.
TEST(QuantityTest, IntervalsOfSharesStayBetween0And1) {
  const MeanInterval plain = interval_of({0.9, 1.0, 0.99}, ValueRange::kAny);
  EXPECT_GT(plain.high, 1.0);
  const MeanInterval share = interval_of({0.9, 1.0, 0.99}, ValueRange::kShare);
  EXPECT_EQ(share.mean, plain.mean);
  EXPECT_GT(share.low, 0.0);
  EXPECT_LT(share.high, 1.0);
  const auto log_odds = [](double p) { return std::log(p / (1.0 - p)); };
  EXPECT_NEAR(log_odds(share.high) + log_odds(share.low), 2.0 * log_odds(share.mean), 1e-9);
  const MeanInterval others = interval_of({0.1, 0.0, 0.01}, ValueRange::kShare);
  EXPECT_NEAR(others.low, 1.0 - share.high, 1e-12);
}

/// Nobody among six made an error: shares of up to a few per cent are not excluded.
TEST(QuantityTest, ValuesThatDoNotVaryHaveAMeanAndNoInterval) {
  std::vector<QuantityValue> none, same;
  for (int person = 0; person < 6; ++person) {
    none.push_back({"P" + std::to_string(person), {}, 0.0});
    same.push_back({"P" + std::to_string(person), {}, 0.7});
  }
  const Quantity errors = quantity("share_wrong", "errors", "", none, {}, ValueRange::kShare);
  ASSERT_FALSE(errors.means.at(0));
  EXPECT_EQ(errors.means[0].because(), "the values do not vary");
  EXPECT_EQ(mean_of(errors, 0), 0.0);
  const Quantity times = quantity("time", "time", "s", same, {}, ValueRange::kPositive);
  EXPECT_FALSE(times.means.at(0));
  EXPECT_EQ(mean_of(times, 0), 0.7);
}

/// Two Weber fractions: Student's interval of their mean goes far below 0.
TEST(QuantityTest, IntervalsOfPositiveValuesStayAbove0) {
  EXPECT_LT(interval_of({0.15, 0.25}, ValueRange::kAny).low, -0.4);
  const MeanInterval positive = interval_of({0.15, 0.25}, ValueRange::kPositive);
  EXPECT_GT(positive.low, 0.0);
  EXPECT_NEAR(positive.low * positive.high, positive.mean * positive.mean, 1e-12);
  // A small error changes nothing but the third digit.
  const MeanInterval narrow = interval_of({0.199, 0.2, 0.201}, ValueRange::kPositive);
  const MeanInterval plain = interval_of({0.199, 0.2, 0.201}, ValueRange::kAny);
  EXPECT_NEAR(narrow.low, plain.low, 1e-4);
}

/// Reaction times and shares of errors of four people, with one bound of equivalence.
std::vector<Quantity> two_quantities(const TrialsPlan& plan) {
  std::vector<QuantityValue> times, shares;
  const std::vector<double> slower{0.010, 0.004, 0.006, 0.012};
  for (std::size_t i = 0; i < slower.size(); ++i) {
    const std::string person = "P" + std::to_string(i);
    times.push_back({person, {"off"}, 0.5});
    times.push_back({person, {"on"}, 0.5 + slower[i]});
    shares.push_back({person, {"off"}, 0.1});
    shares.push_back({person, {"on"}, 0.1 + 2.0 * slower[i]});
  }
  return {quantity("reaction_time", "time", "s", times, plan),
          quantity("share_wrong", "errors", "", shares, plan)};
}

TEST(QuantityTest, ABoundOfEquivalenceIsOfOneQuantity) {
  TrialsPlan plan;
  plan.by = {"light"};
  plan.plan = parse_analysis_plan({"off != on"}, "", "tests");
  plan.plan.beside.equivalence = 0.02;
  const auto tested = [&](const std::string& of) {
    plan.plan.beside.equivalence_of = of;
    std::vector<Quantity> all = two_quantities(plan);
    keep_equivalence(all, plan.plan.beside);
    std::string names;
    for (const Quantity& each : all) {
      names += each.tests.planned.tests.front().equivalence ? each.name : "";
    }
    return names;
  };
  EXPECT_EQ(tested(""), "reaction_time");
  EXPECT_EQ(tested("share_wrong"), "share_wrong");
  EXPECT_EQ(test::message_of<InputError>([&] { tested("share_rong"); }),
            "analysis.equivalence_of is \"share_rong\"; allowed: reaction_time, share_wrong");
}

/// One hypothesis of five quantities is five tests: the first stands alone, as planned, and Holm's
/// p of the four others is that over these four.
TEST(QuantityTest, PlannedTestsAreOfOneQuantity) {
  TrialsPlan plan;
  plan.by = {"light"};
  plan.plan = parse_analysis_plan({"off != on"}, "", "tests");
  const auto five = [&] {
    std::vector<Quantity> all;
    for (int k = 0; k < 5; ++k) {
      std::vector<QuantityValue> values;
      for (int person = 0; person < 6; ++person) {
        const std::string name = "P" + std::to_string(person);
        values.push_back({name, {"off"}, 0.1 * person});
        values.push_back(
            {name, {"on"}, 0.1 * person + 0.05 * k + 0.2 * std::sin(7.0 * person + k)});
      }
      all.push_back(quantity("q" + std::to_string(k), "number", "", values, plan));
    }
    return all;
  };
  const auto test_of = [](const Quantity& q) { return q.tests.planned.tests.front(); };
  std::vector<Quantity> all = five();
  separate_secondary(all, plan);
  EXPECT_EQ(all[0].tests.planned.name, "planned");
  EXPECT_EQ(*test_of(all[0]).holm, test_of(all[0]).t->p);
  std::vector<double> p;
  for (int k = 1; k < 5; ++k) {
    EXPECT_EQ(all[static_cast<std::size_t>(k)].tests.planned.name, "secondary");
    p.push_back(test_of(all[static_cast<std::size_t>(k)]).t->p);
  }
  const auto smallest = std::ranges::min_element(p) - p.begin();
  EXPECT_NEAR(*test_of(all[static_cast<std::size_t>(smallest + 1)]).holm,
              std::min(1.0, 4.0 * p[static_cast<std::size_t>(smallest)]), 1e-12);
  plan.tests_of = "q3";
  all = five();
  separate_secondary(all, plan);
  EXPECT_EQ(all[0].tests.planned.name, "secondary");
  EXPECT_EQ(*test_of(all[3]).holm, test_of(all[3]).t->p);
  plan.tests_of = "q9";
  EXPECT_EQ(test::message_of<InputError>([&] { separate_secondary(all, plan); }),
            "analysis.tests_of is \"q9\"; allowed: q0, q1, q2, q3, q4");
}

TEST(QuantityTest, AnOpenValueLeavesNoMean) {
  const std::vector<QuantityValue> values{
      {"A", {}, 310.0}, {"B", {}, 315.0}, {"C", {}, 326.0, true}, {"D", {}, 312.0}};
  const Quantity thresholds = quantity("threshold", "threshold", "N/m", values, TrialsPlan{});
  ASSERT_EQ(thresholds.means.size(), 1u);
  ASSERT_FALSE(thresholds.means[0]);
  EXPECT_EQ(thresholds.means[0].because(), "1 of 4 values have an interval with an open side (C)");
  EXPECT_EQ(thresholds.open, std::vector<std::string>{"C"});
  EXPECT_FALSE(mean_of(thresholds, 0));
}

TEST(QuantityTest, WithABaselineChangesAreCompared) {
  TrialsPlan plan;
  plan.by = {"group", "session"};
  plan.baseline = "before";
  plan.plan = parse_analysis_plan({"taught, after > alone, after"}, "", "tests");
  std::vector<QuantityValue> values;
  for (int person = 0; person < 6; ++person) {
    const std::string name = "P" + std::to_string(person);
    const std::string group = person < 3 ? "taught" : "alone";
    values.push_back({name, {group, "before"}, 10.0 * person});
    values.push_back(
        {name, {group, "after"}, 10.0 * person + 0.1 * person + (person < 3 ? 4.0 : 1.0)});
  }
  const Quantity changed = quantity("force", "force", "N", values, plan);
  EXPECT_EQ(changed.title, "change of force");
  EXPECT_EQ(changed.table.names, (std::vector<std::string>{"alone, after", "taught, after"}));
  ASSERT_TRUE(changed.tests.planned.tests.front().t);
  EXPECT_NEAR(changed.tests.planned.tests.front().t->difference, 2.7, 1e-12);
}

}  // namespace
}  // namespace haptrial::analysis::trials
