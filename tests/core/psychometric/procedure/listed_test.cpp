#include "core/psychometric/procedure/listed.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <stdexcept>

namespace haptrial::psychometric {
namespace {

std::vector<double> presented(ListedLevels& procedure, double answer) {
  std::vector<double> levels;
  while (!procedure.finished()) {
    levels.push_back(procedure.next()[0]);
    procedure.report(answer, procedure.next());
  }
  return levels;
}

TEST(ConstantStimuliTest, EachLevelAsOftenAsAskedFor) {
  ConstantStimuli procedure({{1.0, 2.0, 3.0}, 40, false}, 1, "levels");
  std::map<double, int> counts;
  const auto levels = presented(procedure, 1.0);
  for (double level : levels) {
    ++counts[level];
  }
  EXPECT_EQ(counts, (std::map<double, int>{{1.0, 40}, {2.0, 40}, {3.0, 40}}));
  ConstantStimuli again({{1.0, 2.0, 3.0}, 40, false}, 1, "levels");
  EXPECT_EQ(presented(again, 0.0), levels);
  ConstantStimuli other({{1.0, 2.0, 3.0}, 40, false}, 2, "levels");
  EXPECT_NE(presented(other, 0.0), levels);
}

TEST(ConstantStimuliTest, InRoundsEveryLevelComesBeforeAnyComesAgain) {
  ConstantStimuli procedure({{1.0, 2.0, 3.0, 4.0}, 25, true}, 1, "levels");
  const auto levels = presented(procedure, 1.0);
  for (std::size_t round = 0; round < 25; ++round) {
    double sum = 0.0;
    double product = 1.0;
    for (std::size_t i = 0; i < 4; ++i) {
      sum += levels[4 * round + i];
      product *= levels[4 * round + i];
    }
    EXPECT_EQ(sum, 10.0);
    EXPECT_EQ(product, 24.0);
  }
}

// All six orders of three levels, 6000 seeds: chi² with 5 degrees of freedom passes 27.9 with a
// probability of 4e-5.
TEST(ConstantStimuliTest, EveryOrderIsAsLikely) {
  std::map<std::vector<double>, int> counts;
  for (std::uint64_t seed = 0; seed < 6000; ++seed) {
    ConstantStimuli procedure({{1.0, 2.0, 3.0}, 1, false}, seed, "levels");
    ++counts[presented(procedure, 1.0)];
  }
  ASSERT_EQ(counts.size(), 6u);
  double chi = 0.0;
  for (const auto& [order, count] : counts) {
    chi += (count - 1000.0) * (count - 1000.0) / 1000.0;
  }
  EXPECT_LT(chi, 27.9);
}

TEST(ConstantStimuliTest, BoundsOfItsParameters) {
  EXPECT_THROW(ConstantStimuli({{}, 1, false}, 1, "l"), std::invalid_argument);
  EXPECT_THROW(ConstantStimuli({{1.0}, 0, false}, 1, "l"), std::invalid_argument);
  EXPECT_THROW(ConstantStimuli({{NAN}, 1, false}, 1, "l"), std::invalid_argument);
  EXPECT_THROW(ConstantStimuli({{1.0}, 1, false}, 1, "l", 1), std::invalid_argument);
  ConstantStimuli three({{1.0}, 2, false}, 1, "l", 3);
  three.report(2, {1.0});
  EXPECT_THROW(three.report(3, {1.0}), std::invalid_argument);
}

TEST(MagnitudeEstimationTest, TheExponentOfAnExactPowerLaw) {
  MagnitudeEstimation procedure({{1.0, 2.0, 5.0, 9.0}, 3, false}, 10.0, 1, "levels");
  while (!procedure.finished()) {
    const Level level = procedure.next();
    procedure.report(7.0 * std::pow(level[0], 0.42), level);
  }
  EXPECT_NEAR(procedure.estimates()[0].value, 0.42, 1e-12);
  EXPECT_NEAR(procedure.estimates()[0].deviation.value(), 0.0, 1e-7);
  EXPECT_EQ(procedure.modulus(), 10.0);
}

// Log levels 0, 1, 2 and log answers 0, 2, 1: slope 1/2, residuals' squares 3/2, error √(3/4).
TEST(MagnitudeEstimationTest, LeastSquaresByHand) {
  MagnitudeEstimation procedure({{1.0}, 3, false}, {}, 1, "levels");
  const double e = std::exp(1.0);
  replay(procedure, std::vector<Outcome>{{1.0, {1.0}}, {e * e, {e}}, {e, {e * e}}});
  EXPECT_NEAR(procedure.estimates()[0].value, 0.5, 1e-14);
  EXPECT_NEAR(procedure.estimates()[0].deviation.value(), std::sqrt(0.75), 1e-14);
}

TEST(MagnitudeEstimationTest, NumbersAboveZero) {
  EXPECT_THROW(MagnitudeEstimation({{0.0}, 1, false}, {}, 1, "l"), std::invalid_argument);
  EXPECT_THROW(MagnitudeEstimation({{1.0}, 1, false}, 0.0, 1, "l"), std::invalid_argument);
  MagnitudeEstimation procedure({{1.0}, 1, false}, {}, 1, "l");
  EXPECT_THROW(procedure.report(0.0, {1.0}), std::invalid_argument);
}

}  // namespace
}  // namespace haptrial::psychometric
