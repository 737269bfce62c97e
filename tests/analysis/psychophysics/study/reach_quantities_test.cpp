// Quantities of reaches between conditions: what enters a value, what is found, and that nothing is
// found where there is nothing. bench_null_trials counts a thousand studies. And how a hand that
// pursues a target responds to it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "analysis/psychophysics/study/pursuit_quantities.h"
#include "analysis/psychophysics/study/reach_quantities.h"
#include "core/base/definition/table.h"
#include "core/base/error.h"
#include "core/base/random.h"
#include "tests/analysis/psychophysics/study/simulated_reaches.h"
#include "tests/support/message_of.h"

namespace haptrial::analysis::trials {
namespace {

using test::reach_plan;
using test::simulated_reaches;
using test::SimulatedReaches;

TEST(ReachQuantitiesTest, AValueIsTheMeanOfTheCyclesThatThePlanTakes) {
  TrialsPlan plan = reach_plan({"group", "block"});
  plan.reaching.cycle = 8;
  for (const ReachCycles cycles : {ReachCycles::kAll, ReachCycles::kFirst, ReachCycles::kLast}) {
    plan.reaching.cycles = cycles;
    const auto study = simulated_reaches({}, plan.reaching);
    const auto quantities = reach_quantities(study.data, study.reaching, plan);
    ASSERT_EQ(quantities.size(), 7u);
    EXPECT_EQ(quantities[1].name, "movement_time");
    EXPECT_EQ(quantities[1].table.cells.size(), 6u) << "two groups, three blocks";
    // The first participant's block "during", by hand.
    const std::size_t from = cycles == ReachCycles::kLast ? 24 : 0;
    const std::size_t to = cycles == ReachCycles::kFirst ? 8 : 32;
    double time = 0.0, slope = 0.0;
    std::size_t reaches = 0, clamps = 0;
    for (std::size_t i = from; i < to; ++i) {
      const StudyReach& reach = study.reaching.reaches[32 + i];
      ASSERT_EQ(reach.block, "during");
      if (reach.kind == ReachKind::kPlain) {
        time += *reach.metrics.movement_time;
        ++reaches;
      } else {
        slope += reach.compensation->slope;
        ++clamps;
      }
    }
    const auto value = [&](const Quantity& q) {
      for (std::size_t cell = 0; cell < q.table.cells.size(); ++cell) {
        if (q.table.names[cell].find("during") != std::string::npos && q.table.means[0][cell]) {
          return *q.table.means[0][cell];
        }
      }
      return std::nan("");
    };
    EXPECT_NEAR(value(quantities[1]), time / static_cast<double>(reaches), 1e-12);
    EXPECT_NEAR(value(quantities[5]), slope / static_cast<double>(clamps), 1e-12);
  }
}

TEST(ReachQuantitiesTest, WhatDiffersIsFoundByThePlannedTests) {
  SimulatedReaches study;
  study.difference_of_groups = 0.015;
  study.rise_of_blocks = 0.01;
  const TrialsPlan plan = reach_plan({"group", "block"});
  const auto made = simulated_reaches(study, plan.reaching);
  const auto quantities = reach_quantities(made.data, made.reaching, plan);
  const Quantity& error = quantities.front();
  ASSERT_EQ(error.tests.planned.tests.size(), 2u);
  const SideTest& groups = error.tests.planned.tests[0];
  const SideTest& blocks = error.tests.planned.tests[1];
  EXPECT_FALSE(groups.paired);
  EXPECT_TRUE(blocks.paired);
  ASSERT_TRUE(groups.t && blocks.t);
  EXPECT_LT(groups.t->p, 1e-4);
  EXPECT_LT(blocks.t->p, 1e-6);
  EXPECT_NEAR(std::abs(groups.t->difference), 0.015, 0.006);
  EXPECT_NEAR(std::abs(blocks.t->difference), 0.02, 0.005);
}

/// Reaches over 60 and 120 mm that end 4 mm around the target and take 0.4 and 0.6 s.
TEST(ReachQuantitiesTest, ThroughputIsBitsOfTheWidthThatWasUsedOverTime) {
  constexpr int kReaches = 4000;
  TrialsPlan plan = reach_plan({"group"});
  plan.reaching.quantities = {ReachQuantity::kThroughput};
  auto made = simulated_reaches({}, plan.reaching);
  made.data.sessions.resize(2);
  made.data.sessions[1].group = "b";
  made.data.trials.clear();
  made.reaching.reaches.clear();
  made.reaching.persons.clear();
  made.reaching.block_of.assign(kReaches, 0);
  RandomStream random(1, "ends");
  for (int i = 0; i < kReaches; ++i) {
    const bool is_far = i % 4 < 2;
    StudyTrial trial;
    trial.session = static_cast<std::size_t>(i % 2);
    StudyReach reach;
    reach.trial = made.data.trials.size();
    reach.way.target = {is_far ? 0.12 : 0.06, 0.0, 0.0};
    reach.metrics.endpoint_extent = 0.004 * random.normal();
    reach.metrics.movement_time = (is_far ? 0.6 : 0.4) * (i % 2 == 0 ? 1.0 : 2.0);
    made.data.trials.push_back(trial);
    made.reaching.reaches.push_back(reach);
    made.reaching.persons.push_back(trial.session);
  }
  const auto quantities = reach_quantities(made.data, made.reaching, plan);
  ASSERT_EQ(quantities.size(), 1u);
  const double width = std::sqrt(2.0 * M_PI * M_E) * 0.004;  // of a normal's entropy
  const double bits =
      0.5 * (std::log2(0.06 / width + 1.0) / 0.4 + std::log2(0.12 / width + 1.0) / 0.6);
  const auto& means = quantities[0].table.means;
  EXPECT_NEAR(*means[0][0] / bits, 1.0, 0.03);
  EXPECT_NEAR(*means[1][1] / (bits / 2.0), 1.0, 0.03);
}

/// Nearly all reaches under one condition never slow down over the short way, which is fast.
TEST(ReachQuantitiesTest, ConditionsAreComparedOverTheCombinationsThatBothHave) {
  constexpr int kReaches = 400;
  TrialsPlan plan = reach_plan({"block"});
  plan.reaching.quantities = {ReachQuantity::kThroughput, ReachQuantity::kMovementTime};
  auto made = simulated_reaches({}, plan.reaching);
  made.data.sessions.resize(1);
  made.data.trials.clear();
  made.reaching.reaches.clear();
  made.reaching.persons.assign(kReaches, 0);
  made.reaching.block_of.assign(kReaches, 0);
  RandomStream random(1, "ends");
  for (int i = 0; i < kReaches; ++i) {
    const bool is_far = i % 4 < 2, second = i % 2 == 1;
    StudyTrial trial;
    trial.variables.push_back({"block", 0, second ? 2.0 : 1.0, {}});
    StudyReach reach;
    reach.trial = made.data.trials.size();
    reach.way.target = {is_far ? 0.12 : 0.06, 0.0, 0.0};
    if (is_far || !second) {
      reach.metrics.endpoint_extent = i / 4 % 2 == 0 ? 0.004 : -0.004;
      reach.metrics.movement_time = is_far ? 0.6 : 0.4;
    }
    made.data.trials.push_back(trial);
    made.reaching.reaches.push_back(reach);
  }
  const auto quantities = reach_quantities(made.data, made.reaching, plan);
  ASSERT_EQ(quantities.size(), 2u);
  const auto& means = quantities[0].table.means;
  ASSERT_EQ(means.size(), 1u);
  ASSERT_EQ(means[0].size(), 2u);
  EXPECT_NEAR(*means[0][0], *means[0][1], 1e-9) << "over the long way alone";
  EXPECT_THAT(quantities[0].missing,
              testing::ElementsAre(testing::HasSubstr("over 1 of 2 combinations")));
  EXPECT_THAT(quantities[1].missing,
              testing::ElementsAre(testing::HasSubstr("100 of 200 reaches have none")));
}

/// Everybody comes on a second day and reaches as on the first, but 10 mm farther off the way, and
/// each person 1 mm farther than the one before.
test::ReachesOfStudy two_days(const ReachingPlan& plan) {
  SimulatedReaches study;
  study.participants = 4;
  test::ReachesOfStudy made = simulated_reaches(study, plan);
  const test::ReachesOfStudy day = made;
  for (StudySession session : day.data.sessions) {
    session.session = 2;
    made.data.sessions.push_back(session);
  }
  for (std::size_t i = 0; i < day.reaching.reaches.size(); ++i) {
    StudyTrial trial = day.data.trials[i];
    StudyReach reach = day.reaching.reaches[i];
    const auto person = static_cast<double>(day.reaching.persons[i]);
    reach.trial = made.data.trials.size();
    *reach.metrics.maximum_perpendicular_error += 0.01 + 0.001 * person;
    trial.session += day.data.sessions.size();
    made.data.trials.push_back(trial);
    made.reaching.reaches.push_back(reach);
    made.reaching.persons.push_back(day.reaching.persons[i]);
    made.reaching.block_of.push_back(3 + day.reaching.block_of[i]);
  }
  return made;
}

TEST(ReachQuantitiesTest, SessionsHaveCyclesOfTheirOwn) {
  TrialsPlan plan = reach_plan({"session"});
  plan.plan.tests.clear();
  plan.reaching.cycle = 8;
  plan.reaching.quantities = {ReachQuantity::kError};
  for (const ReachCycles cycles : {ReachCycles::kAll, ReachCycles::kFirst, ReachCycles::kLast}) {
    plan.reaching.cycles = cycles;
    const auto made = two_days(plan.reaching);
    const auto quantities = reach_quantities(made.data, made.reaching, plan);
    const auto& means = quantities.at(0).table.means;
    ASSERT_EQ(means.size(), 4u);
    for (std::size_t person = 0; person < 4; ++person) {
      ASSERT_TRUE(means[person].at(0) && means[person].at(1));
      EXPECT_NEAR(*means[person][1] - *means[person][0], 0.01 + 0.001 * static_cast<double>(person),
                  1e-12);
    }
  }
}

TEST(ReachQuantitiesTest, BlocksOfTheSameNameStayApartOverSessions) {
  ReachingPlan plan = reach_plan({"session"}).reaching;
  plan.cycle = 8;
  const auto made = two_days(plan);
  const ReachingResult result = reaching_study(made.data, made.reaching.reaches, plan, 1);
  std::vector<std::string> names;
  for (std::size_t b = 0; b < result.blocks.size(); ++b) {
    names.push_back(result.blocks[b].name);
    EXPECT_EQ(result.blocks[b].trials, 32u);
    EXPECT_EQ(result.blocks[b].first_cycle, 4 * b);
  }
  EXPECT_THAT(names,
              testing::ElementsAre("session 1, before", "session 1, during", "session 1, after",
                                   "session 2, before", "session 2, during", "session 2, after"));
  std::size_t compared = 0;
  for (const ReachContrast& each : result.contrasts) {
    if (each.name == "session 2, during: first cycle against that of session 1, during") {
      ASSERT_TRUE(each.contrast);
      EXPECT_NEAR(each.contrast->test.difference, 0.0115, 1e-12);
      ++compared;
    }
  }
  EXPECT_EQ(compared, 1u);
}

TEST(ReachQuantitiesTest, WithoutConditionsThereIsOneMean) {
  TrialsPlan plan = reach_plan({"group"});
  plan.by.clear();
  plan.reaching.quantities = {ReachQuantity::kMovementTime};
  auto made = simulated_reaches({}, plan.reaching);
  const auto quantities = reach_quantities(made.data, made.reaching, plan);
  ASSERT_EQ(quantities.size(), 1u);
  EXPECT_FALSE(quantities[0].compared);
  ASSERT_EQ(quantities[0].means.size(), 1u);
  EXPECT_TRUE(quantities[0].means[0]);
  made.reaching.plan.quantities = {ReachQuantity::kError};
  EXPECT_TRUE(reach_quantities(made.data, made.reaching, plan).empty()) << "it has its curves";
}

TEST(ReachQuantitiesTest, EveryTestKeepsItsLevel) {
  constexpr std::size_t kStudies = 150;
  const auto band = test::binomial_band(kStudies, 1.0 - 1e-7);
  for (const std::vector<std::string>& by :
       {std::vector<std::string>{"group"}, {"block"}, {"group", "block"}}) {
    const auto levels = test::null_reaches(by, kStudies, 3, 2);
    EXPECT_GE(levels.size(), 7u * 4u);
    for (const test::NullLevel& level : levels) {
      EXPECT_LE(level.found, band.high) << level.test;
      EXPECT_EQ(level.replications, kStudies) << level.test;
    }
  }
}

TEST(ReachQuantitiesTest, TheDefinitionStatesThem) {
  const auto read = [](const std::string& keys) {
    Table root = Table::parse("[analysis]\nkind = \"reaching\"\n" + keys, "study.toml");
    PlanDefaults defaults;
    defaults.factors = {"direction"};
    defaults.names = {"block", "group"};
    TrialsPlan plan = read_trials_plan(root, defaults);
    root.finish();
    return plan;
  };
  EXPECT_TRUE(read("").by.empty());
  const TrialsPlan plan = read(
      "by = [\"group\", \"block\"]\ntests = [\"gradual < abrupt\"]\ncycles = \"first\"\n"
      "quantities = [\"error\", \"force_compensation\"]\n");
  EXPECT_EQ(plan.by, (std::vector<std::string>{"group", "block"}));
  ASSERT_EQ(plan.plan.tests.size(), 1u);
  EXPECT_EQ(plan.reaching.cycles, ReachCycles::kFirst);
  EXPECT_EQ(plan.reaching.quantities,
            (std::vector{ReachQuantity::kError, ReachQuantity::kForceCompensation}));
  EXPECT_THAT(haptrial::test::message_of([&] { read("tests = [\"a < b\"]\n"); }),
              testing::HasSubstr("compares conditions, but there are none"));
  EXPECT_THAT(haptrial::test::message_of([&] { read("quantities = [\"errors\"]\n"); }),
              testing::HasSubstr("allowed: error, movement_time"));
}

/// A hand with gain 0.8 and a lag of 0.1 s at 0.3 Hz, gain 0.5 and 0.05 s at 1.1 Hz, and noise,
/// along a slanted line.
TEST(PursuitResponseTest, GainAndLagAreThoseOfTheHand) {
  const Eigen::Vector3d along = Eigen::Vector3d(1.0, 2.0, -0.5).normalized();
  RandomStream random(1, "hand");
  std::vector<Eigen::Vector3d> target, hand;
  constexpr double kNoise = 0.001;
  for (int tick = 0; tick < 20'000; ++tick) {
    const double t = tick / 1000.0;
    const auto sine = [](double f, double at, double phase) {
      return std::sin(2.0 * M_PI * f * at + phase);
    };
    target.push_back((0.02 * sine(0.3, t, 1.0) + 0.01 * sine(1.1, t, 2.0)) * along);
    hand.push_back((0.016 * sine(0.3, t - 0.1, 1.0) + 0.005 * sine(1.1, t - 0.05, 2.0) +
                    kNoise * random.normal()) *
                   along);
  }
  const PursuitResponse found = pursuit_response(target, hand, 1000.0, {0.3, 1.1});
  EXPECT_NEAR(std::abs(found.response[0]), 0.8, 0.003);
  EXPECT_NEAR(std::abs(found.response[1]), 0.5, 0.005);
  EXPECT_NEAR(-std::arg(found.response[0]) / (2.0 * M_PI * 0.3), 0.1, 0.002);
  EXPECT_NEAR(-std::arg(found.response[1]) / (2.0 * M_PI * 1.1), 0.05, 0.002);
  const double movement = 0.5 * (0.016 * 0.016 + 0.005 * 0.005);
  EXPECT_NEAR(found.followed, movement / (movement + kNoise * kNoise), 0.002);
  double square = 0.0;
  for (std::size_t i = 0; i < target.size(); ++i) {
    square += (target[i] - hand[i]).squaredNorm() / 20'000.0;
  }
  EXPECT_NEAR(found.error, std::sqrt(square), 1e-12);
}

/// The drift lies across the swing and is far larger than it; the hand is 0.2 s late in both.
TEST(PursuitResponseTest, ADriftOfTheTargetIsNoPartOfItsSwing) {
  std::vector<Eigen::Vector3d> target, hand;
  const auto place = [](double t) {
    return Eigen::Vector3d(0.01 * t, 0.02 * std::sin(2.0 * M_PI * 0.13 * t + 1.0), 0.005 * t);
  };
  for (int tick = 0; tick < 38'000; ++tick) {
    target.push_back(place(tick / 1000.0));
    hand.push_back(place(tick / 1000.0 - 0.2));
  }
  const PursuitResponse found = pursuit_response(target, hand, 1000.0, {0.13});
  EXPECT_NEAR(std::abs(found.response[0]), 1.0, 1e-9);
  EXPECT_NEAR(-std::arg(found.response[0]) / (2.0 * M_PI * 0.13), 0.2, 1e-9);
  EXPECT_NEAR(found.followed, 1.0, 1e-9);
}

TEST(PursuitResponseTest, FrequenciesThatTheTargetLacksHaveNoGain) {
  std::vector<Eigen::Vector3d> target, hand;
  const auto place = [](double t) {
    return Eigen::Vector3d(0.02 * std::sin(2.0 * M_PI * 0.1 * t) + 0.01 * std::cos(3.1 * t), 0.0,
                           0.0);
  };
  for (int tick = 0; tick < 37'000; ++tick) {
    target.push_back(place(tick / 1000.0));
    hand.push_back(place(tick / 1000.0 - 0.2));
  }
  const double other = 3.1 / (2.0 * M_PI);  // [Hz]
  const PursuitResponse whole = pursuit_response(target, hand, 1000.0, {0.1, other, 0.4});
  EXPECT_NEAR(-std::arg(whole.response[0]) / (2.0 * M_PI * 0.1), 0.2, 1e-9);
  EXPECT_NEAR(-std::arg(whole.response[1]) / 3.1, 0.2, 1e-9);
  EXPECT_TRUE(std::isnan(whole.response[2].real()));
  EXPECT_TRUE(std::isnan(whole.followed));
  const PursuitResponse part = pursuit_response(target, hand, 1000.0, {0.1});
  EXPECT_TRUE(std::isnan(part.response[0].real()));  // the other sine leaks into it
}

/// Movement across the target's line is no error of the pursuit.
TEST(PursuitResponseTest, OnlyDirectionsCountInWhichTheTargetMoves) {
  std::vector<Eigen::Vector3d> target, hand;
  for (int tick = 0; tick < 1000; ++tick) {
    target.emplace_back(0.01 * std::sin(0.02 * tick), 0.0, 0.0);
    hand.emplace_back(target.back().x() + 0.003, 0.05, 0.0);
  }
  EXPECT_NEAR(pursuit_response(target, hand, 1000.0, {}).error, 0.003, 1e-12);
}

}  // namespace
}  // namespace haptrial::analysis::trials
