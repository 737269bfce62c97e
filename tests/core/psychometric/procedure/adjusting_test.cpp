#include "core/psychometric/procedure/adjusting.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace haptrial::psychometric {
namespace {

AdjustingParameters from(std::vector<double> starts) {
  AdjustingParameters p;
  p.starts.levels = std::move(starts);
  p.starts.in_rounds = true;
  p.steps = {4.0, 2.0, 1.0};
  p.low = 0.0;
  p.high = 30.0;
  return p;
}

void answer(Adjusting& procedure, double answer) { procedure.report(answer, procedure.next()); }

TEST(AdjustingTest, StepsGetFinerAtEveryTurnAndASettingEndsAnAdjustment) {
  Adjusting procedure(from({10.0}), 1, "a");
  EXPECT_EQ(procedure.next(), Level{10.0});
  answer(procedure, 1.0);
  EXPECT_EQ(procedure.next(), Level{14.0});
  answer(procedure, 1.0);
  EXPECT_EQ(procedure.next(), Level{18.0});
  answer(procedure, -1.0);  // a turn
  EXPECT_EQ(procedure.next(), Level{16.0});
  answer(procedure, 1.0);  // another
  EXPECT_EQ(procedure.next(), Level{17.0});
  answer(procedure, -1.0);  // there is no finer step
  EXPECT_EQ(procedure.next(), Level{16.0});
  answer(procedure, 0.0);
  EXPECT_TRUE(procedure.finished());
  ASSERT_EQ(procedure.settings().size(), 1U);
  EXPECT_EQ(procedure.settings()[0], 16.0);
  EXPECT_THROW(procedure.next(), std::logic_error);
}

TEST(AdjustingTest, TheLevelThatWasPresentedIsWhereItGoesOnFrom) {
  Adjusting procedure(from({10.0}), 1, "a");
  procedure.report(1.0, {10.5});  // rounded by the device
  EXPECT_EQ(procedure.next(), Level{14.5});
  procedure.report(0.0, {14.25});
  EXPECT_EQ(procedure.settings()[0], 14.25);
}

TEST(AdjustingTest, StaysWithinItsRangeAndGivesUpAnEndlessAdjustment) {
  AdjustingParameters p = from({28.0});
  p.most_presentations = 5;
  Adjusting procedure(p, 1, "a");
  for (int i = 0; i < 5; ++i) {
    answer(procedure, 1.0);
    if (!procedure.finished()) {
      EXPECT_LE(procedure.next().front(), 30.0);
    }
  }
  EXPECT_TRUE(procedure.finished());
  EXPECT_TRUE(procedure.estimates().empty());
}

TEST(AdjustingTest, AdjustmentsWithoutASettingAreSaidBesideTheMeanOfTheOthers) {
  AdjustingParameters p = from({5.0, 25.0});
  p.most_presentations = 2;
  Adjusting procedure(p, 1, "a");
  answer(procedure, 1.0);
  answer(procedure, 1.0);
  const double set = procedure.next().front();
  answer(procedure, 0.0);
  ASSERT_TRUE(procedure.finished());
  const std::vector<Estimate> estimates = procedure.estimates();
  ASSERT_EQ(estimates.size(), 1u);
  EXPECT_EQ(estimates[0].value, set);
  EXPECT_EQ(estimates[0].remark, "1 of 2 adjustments ended without a setting");
}

TEST(AdjustingTest, SettingsThatDoNotVaryTellNoDeviation) {
  AdjustingParameters p = from({5.0, 5.0, 5.0});
  Adjusting procedure(p, 1, "a");
  while (!procedure.finished()) {
    answer(procedure, 0.0);
  }
  const std::vector<Estimate> estimates = procedure.estimates();
  ASSERT_EQ(estimates.size(), 1u);
  EXPECT_EQ(estimates[0].value, 5.0);
  EXPECT_FALSE(estimates[0].deviation);
}

TEST(AdjustingTest, SomebodyWhoKnowsTheStandardSetsItFromBothSides) {
  AdjustingParameters p = from({5.0, 25.0});
  p.starts.repetitions = 3;
  Adjusting procedure(p, 7, "a");
  int presentations = 0;
  while (!procedure.finished() && ++presentations < 500) {
    const double d = procedure.next().front() - 13.2;
    answer(procedure, std::abs(d) <= 0.5 ? 0.0 : d > 0.0 ? -1.0 : 1.0);
  }
  ASSERT_EQ(procedure.settings().size(), 6U);
  for (const double setting : procedure.settings()) {
    EXPECT_NEAR(setting, 13.2, 0.5);
  }
  const auto estimates = procedure.estimates();
  ASSERT_EQ(estimates.size(), 1U);
  EXPECT_EQ(estimates[0].name, "mean of 6 settings, both sides alike");
  EXPECT_NEAR(estimates[0].value, 13.2, 0.5);
}

// 1, 2, 3, 6: mean 3, standard deviation √(14/3), error √(14/12).
TEST(AdjustingTest, MeanAndStandardErrorOfTheSettings) {
  AdjustingParameters parameters;
  parameters.starts = {{1.0, 2.0, 3.0, 6.0}, 1, false};
  parameters.low = 0.0;
  parameters.high = 10.0;
  Adjusting procedure(parameters, 1, "starts");
  EXPECT_TRUE(procedure.estimates().empty());
  while (!procedure.finished()) {
    procedure.report(0.0, Level(procedure.next()));
  }
  EXPECT_DOUBLE_EQ(procedure.estimates()[0].value, 3.0);
  EXPECT_NEAR(procedure.estimates()[0].deviation.value(), std::sqrt(14.0 / 12.0), 1e-14);
}

// Settings of 1, 2 and 3 from below and 5 and 7 from above: means 2 and 6, mean 4. Squares within
// sides 2 + 2 with 3 degrees of freedom, so the error is sqrt(4/3 (1/3 + 1/2)) / 2.
TEST(AdjustingTest, SettingsFromEitherSideCountAlikeAndTheirDifferenceIsNoScatter) {
  AdjustingParameters p;
  p.starts = {{0.0, 10.0}, 3, true};
  p.steps = {1.0};
  p.low = 0.0;
  p.high = 10.0;
  Adjusting procedure(p, 5, "starts");
  std::vector<double> below{1.0, 2.0, 3.0}, above{5.0, 7.0};
  while (!procedure.finished()) {
    const bool under = procedure.next().front() == 0.0;
    auto& left = under ? below : above;
    if (left.empty()) {  // the third from above is given up
      procedure.report(1.0, Level(procedure.next()));
      while (!procedure.finished() && procedure.next().front() == 10.0) {
        procedure.report(1.0, Level(procedure.next()));
      }
      continue;
    }
    procedure.report(under ? 1.0 : -1.0, Level(procedure.next()));
    procedure.report(0.0, {left.front()});
    left.erase(left.begin());
  }
  const auto estimate = procedure.estimates().at(0);
  ASSERT_EQ(procedure.settings().size(), 5U);
  EXPECT_DOUBLE_EQ(estimate.value, 4.0);
  EXPECT_NEAR(estimate.deviation.value(), 0.5 * std::sqrt(4.0 / 3.0 * (1.0 / 3.0 + 0.5)), 1e-14);
  EXPECT_DOUBLE_EQ(estimate.freedom.value(), 3.0);
}

TEST(AdjustingTest, ARepetitionOfTheOutcomesGivesTheSameLevels) {
  AdjustingParameters p = from({5.0, 15.0, 25.0});
  p.starts.repetitions = 2;
  Adjusting first(p, 3, "a");
  std::vector<Outcome> outcomes;
  for (int i = 0; i < 25 && !first.finished(); ++i) {
    outcomes.push_back({i % 4 == 3 ? 0.0 : i % 3 == 0 ? 1.0 : -1.0, first.next()});
    first.report(outcomes.back().answer, outcomes.back().applied);
  }
  Adjusting again(p, 3, "a");
  replay(again, outcomes);
  EXPECT_EQ(again.settings(), first.settings());
  EXPECT_EQ(again.finished(), first.finished());
}

// Everybody ends at 280 from below and at 340 from above, so neither side has any scatter.
TEST(AdjustingTest, AnotherOrderOfStartsDoesNotMixTheSides) {
  AdjustingParameters p;
  p.starts = {{100.0, 800.0}, 4, false};
  p.steps = {20.0};
  p.low = 50.0;
  p.high = 900.0;
  Adjusting session(p, 3, "S02");
  std::vector<Outcome> outcomes;
  bool below = true, fresh = true;
  while (!session.finished()) {
    const double level = session.next().front();
    below = fresh ? level < 300.0 : below;
    const double answer = below ? (level < 278.0 ? 1.0 : 0.0) : (level > 342.0 ? -1.0 : 0.0);
    fresh = answer == 0.0;
    outcomes.push_back({answer, session.next()});
    session.report(answer, outcomes.back().applied);
  }
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
    Adjusting again(p, seed, "another order");
    replay(again, outcomes);
    const auto estimate = again.estimates().at(0);
    EXPECT_EQ(estimate.name, "mean of 8 settings, both sides alike");
    EXPECT_DOUBLE_EQ(estimate.value, 310.0);
    EXPECT_FALSE(estimate.deviation) << "within a side they do not vary";
  }
}

TEST(AdjustingTest, RefusesWhatItCannotUse) {
  AdjustingParameters p = from({40.0});
  EXPECT_THROW(Adjusting(p, 1, "a"), std::invalid_argument);
  p = from({10.0});
  p.steps = {1.0, 0.0};
  EXPECT_THROW(Adjusting(p, 1, "a"), std::invalid_argument);
  Adjusting procedure(from({10.0}), 1, "a");
  EXPECT_THROW(procedure.report(2.0, {10.0}), std::invalid_argument);
}

}  // namespace
}  // namespace haptrial::psychometric
