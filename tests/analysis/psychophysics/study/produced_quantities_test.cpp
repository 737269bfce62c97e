#include "analysis/psychophysics/study/produced_quantities.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace haptrial::analysis::trials {
namespace {

using Eigen::Vector3d;

/// A circle of 10 mm about the origin in a second, under a force of 2 N that turns with it.
std::vector<ProducedTick> circle() {
  std::vector<ProducedTick> ticks;
  for (int i = 0; i <= 1000; ++i) {
    const double angle = 2.0 * std::numbers::pi * 1e-3 * i;
    const Vector3d out(std::cos(angle), std::sin(angle), 0.0);
    const Vector3d along(-out.y(), out.x(), 0.0);
    ticks.push_back({0.01 * out, 0.01 * 2.0 * std::numbers::pi * along, -2.0 * out});
  }
  return ticks;
}

double value(ProducedQuantity quantity, ProducedStatistic statistic) {
  ProducedPlan plan;
  plan.quantity = quantity;
  plan.statistic = statistic;
  return produced_value(circle(), plan);
}

TEST(ProducedQuantitiesTest, ACircleHasItsOwnNumbers) {
  using Q = ProducedQuantity;
  using S = ProducedStatistic;
  EXPECT_NEAR(value(Q::kForce, S::kMean), 2.0, 1e-12);
  EXPECT_NEAR(value(Q::kForce, S::kDeviation), 0.0, 1e-7);
  EXPECT_NEAR(value(Q::kPath, S::kMean), 2.0 * std::numbers::pi * 0.01, 1e-6);
  EXPECT_NEAR(value(Q::kSpeed, S::kPeak), 2.0 * std::numbers::pi * 0.01, 1e-12);
  EXPECT_NEAR(value(Q::kX, S::kEnd), 0.01, 1e-12);
  EXPECT_NEAR(value(Q::kY, S::kDeviation), 0.01 / std::numbers::sqrt2, 1e-5);
  EXPECT_NEAR(std::abs(value(Q::kY, S::kPeak)), 0.01, 1e-12);
}

}  // namespace
}  // namespace haptrial::analysis::trials
