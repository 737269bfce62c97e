#include "analysis/psychophysics/study/population.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/base/random.h"

namespace haptrial::analysis::trials {
namespace {

double phi(double z) { return 0.5 * std::erfc(-z / std::sqrt(2.0)); }

/// People whose point and width change from condition to condition, each in a way of their own and
/// in the mean not at all. Widths vary by `slope_sd` as logarithms.
std::vector<AnsweredSeries> people_alike(int people, int trials, double slope_sd,
                                         std::uint64_t seed) {
  RandomStream random(seed, "people");
  std::vector<AnsweredSeries> all;
  for (int person = 0; person < people; ++person) {
    const double point = 0.5 * random.normal(), log_width = 0.15 * random.normal();
    for (const char* condition : {"off", "on"}) {
      const double own_point = point + 0.3 * random.normal();
      const double width = 1.2 * std::exp(log_width + slope_sd * random.normal());
      AnsweredSeries series;
      series.participant = "P" + std::to_string(person);
      series.levels = {condition};
      for (const double level : {-2.5, -1.5, -0.5, 0.5, 1.5, 2.5}) {
        for (int trial = 0; trial < trials; ++trial) {
          LevelTrial answered;
          answered.level = level;
          answered.outcome = random.uniform() < phi((level - own_point) / width) ? 1 : 0;
          series.trials.push_back(answered);
        }
      }
      all.push_back(std::move(series));
    }
  }
  return all;
}

TrialsPlan plan_without_guesses() {
  TrialsPlan plan;
  plan.by = {"condition"};
  plan.function.guess = 0.0;
  return plan;
}

/// A person's answers are many, but a slope that changes in each person's own way is one value of a
/// person: its interval misses 0 in one study of twenty, whatever the trials.
TEST(PopulationModelTest, SlopesThatChangeInEachPersonAreNoEffectOfTheCondition) {
  int slope = 0, condition = 0;
  constexpr int kStudies = 20;
  for (int study = 0; study < kStudies; ++study) {
    const auto made =
        population_model(people_alike(6, 30, 0.25, 400 + study), plan_without_guesses());
    ASSERT_TRUE(made) << made.because();
    const auto& c = made->model.fixed.coefficients;
    slope += c[3].low <= 0.0 && 0.0 <= c[3].high;
    condition += c[2].low <= 0.0 && 0.0 <= c[2].high;
  }
  RecordProperty("slope_intervals_with_0_of_20", slope);
  // At 95 %, 16 or fewer are one count of sixty.
  EXPECT_GE(slope, 17);
  EXPECT_GE(condition, 17);
}

TEST(PopulationModelTest, IntervalsAreOfStudentsTOverParticipants) {
  const auto made = population_model(people_alike(6, 20, 0.1, 9), plan_without_guesses());
  ASSERT_TRUE(made) << made.because();
  constexpr double kT = 2.570581836;  // R: qt(0.975, 5)
  for (const BinomialCoefficient& c : made->model.fixed.coefficients) {
    EXPECT_NEAR(c.high - c.estimate, kT * c.error, 1e-8);
    EXPECT_EQ(c.p<0.05, c.low> 0.0 || c.high < 0.0);
  }
  for (const PopulationPoint& each : made->points) {
    ASSERT_TRUE(each.point);
    EXPECT_NEAR(each.point->point - each.point->point_low, kT * each.point->point_error, 1e-8);
    EXPECT_NEAR(each.point->jnd_high - each.point->jnd, kT * each.point->jnd_error, 1e-8);
  }
}

}  // namespace
}  // namespace haptrial::analysis::trials
