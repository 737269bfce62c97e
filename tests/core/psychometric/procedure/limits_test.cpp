#include "core/psychometric/procedure/limits.h"

#include <gmock/gmock.h>
#include <gsl/gsl_cdf.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

#include "core/base/random.h"

namespace haptrial::psychometric {
namespace {

using testing::ElementsAre;

LimitsParameters ten_levels() {
  LimitsParameters p;
  p.low = 0.0;
  p.high = 10.0;
  p.step = 1.0;
  p.series = 8;
  p.start_steps = 0;
  return p;
}

/// Answers 1 from a level on.
std::vector<double> series_from(double threshold, Limits& procedure) {
  std::vector<double> levels;
  while (!procedure.finished()) {
    const double level = procedure.next().front();
    levels.push_back(level);
    procedure.report(level >= threshold ? 1.0 : 0.0, {level});
  }
  return levels;
}

TEST(LimitsTest, SeriesDescendAndAscendInTurnUntilTheAnswerChanges) {
  LimitsParameters p = ten_levels();
  p.series = 2;
  Limits procedure(p, 1, "a");
  EXPECT_THAT(series_from(6.5, procedure),
              ElementsAre(10.0, 9.0, 8.0, 7.0, 6.0,                          // yes … no
                          0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0));  // no … yes
  ASSERT_EQ(procedure.estimates().size(), 1U);
  EXPECT_EQ(procedure.estimates()[0].value, 6.5);
  EXPECT_EQ(procedure.estimates()[0].name, "threshold, mean of 2 series");
  EXPECT_THROW(procedure.next(), std::logic_error);
}

TEST(LimitsTest, ASeriesMayBeginAnywhereNearItsEnd) {
  LimitsParameters p = ten_levels();
  p.series = 400;
  p.start_steps = 3;
  p.descending_first = false;
  Limits procedure(p, 1, "a");
  std::array<int, 4> up{}, down{};
  bool begins = true, ascends = true;
  while (!procedure.finished()) {
    const double level = procedure.next().front();
    if (begins) {
      ++(ascends ? up : down).at(static_cast<std::size_t>(ascends ? level : 10.0 - level));
    }
    const bool felt = level >= 5.0;
    begins = felt == ascends;
    ascends = begins ? !ascends : ascends;
    procedure.report(felt ? 1.0 : 0.0, {level});
  }
  for (const auto& counts : {up, down}) {
    for (const int count : counts) {
      EXPECT_NEAR(count, 50, 4.0 * std::sqrt(200 * 0.25 * 0.75));  // binomial
    }
  }
}

TEST(LimitsTest, ASeriesWithoutAChangeCountsForNothingAndIsSaid) {
  LimitsParameters p = ten_levels();
  Limits never(p, 1, "a");
  EXPECT_EQ(series_from(20.0, never).size(), 4U + 4U * 11U);
  EXPECT_TRUE(never.estimates().empty());
  Limits once(p, 1, "a");
  for (int trial = 0; trial < 4 * (1 + 11) - 1; ++trial) {
    once.report(0.0, once.next());
  }
  once.report(1.0, once.next());  // at the end of the range
  ASSERT_EQ(once.estimates().size(), 1U);
  EXPECT_EQ(once.estimates()[0].value, 9.5);
  EXPECT_EQ(once.estimates()[0].remark, "7 of 8 series had no change of the answer within the range");
}

double share_felt(double level) { return 1.0 / (1.0 + std::exp(-(level - 4.7) / 0.9)); }

/// The mean of the thresholds of a series that begins at `start`, by its law.
double expected_from(double start, double step) {
  double going = 1.0, mean = 0.0, shares = 0.0;
  for (double level = start; level >= 0.0 && level <= 10.0; level += step) {
    const double change = step < 0.0 ? 1.0 - share_felt(level) : share_felt(level);
    if (level != start) {
      mean += going * change * (level - 0.5 * step);
      shares += going * change;
    }
    going *= 1.0 - change;
  }
  return mean / shares;
}

TEST(LimitsTest, TheEstimateHasTheMeanOfItsLawAndItsIntervalHoldsIt) {
  double law = 0.0;
  for (int steps = 0; steps <= 3; ++steps) {
    law += (expected_from(10.0 - steps, -1.0) + expected_from(steps, 1.0)) / 8.0;
  }
  LimitsParameters p = ten_levels();
  p.start_steps = 3;
  p.series = 10;
  constexpr int kProcedures = 2000;
  double sum = 0.0, squares = 0.0;
  int held = 0;
  for (int i = 0; i < kProcedures; ++i) {
    Limits procedure(p, static_cast<std::uint64_t>(i), "a");
    RandomStream random(static_cast<std::uint64_t>(i), "answers");
    while (!procedure.finished()) {
      const Level level = procedure.next();
      procedure.report(random.uniform() < share_felt(level[0]) ? 1.0 : 0.0, level);
    }
    const Estimate estimate = procedure.estimates().at(0);
    sum += estimate.value;
    squares += estimate.value * estimate.value;
    const double t = gsl_cdf_tdist_Pinv(0.975, estimate.freedom.value());
    held += std::abs(estimate.value - law) <= t * estimate.deviation.value() ? 1 : 0;
  }
  const double mean = sum / kProcedures;
  const double error = std::sqrt((squares / kProcedures - mean * mean) / kProcedures);
  EXPECT_NEAR(mean, law, 4.0 * error);
  EXPECT_GE(held, 0.93 * kProcedures);
  EXPECT_LE(held, 0.97 * kProcedures);
}

/// A report replays what was recorded, whatever seed drew where its series began.
TEST(LimitsTest, EstimatesFollowFromTheOutcomesAlone) {
  LimitsParameters p = ten_levels();
  p.start_steps = 3;
  Limits recorded(p, 5, "a"), replayed(p, 1, "another");
  while (!recorded.finished()) {
    const Level level = recorded.next();
    const double answer = level[0] >= 4.6 ? 1.0 : 0.0;
    recorded.report(answer, level);
    replayed.report(answer, level);
  }
  ASSERT_TRUE(replayed.finished());
  EXPECT_EQ(recorded.estimates().at(0).value, replayed.estimates().at(0).value);
  EXPECT_TRUE(replayed.estimates().at(0).remark.empty());
}

TEST(LimitsTest, RefusesWhatCannotBegin) {
  LimitsParameters p = ten_levels();
  p.step = 11.0;
  EXPECT_THROW(Limits(p, 1, "a"), std::invalid_argument);
  p = ten_levels();
  p.start_steps = 6;
  EXPECT_THROW(Limits(p, 1, "a"), std::invalid_argument);
}

}  // namespace
}  // namespace haptrial::psychometric
