#include "core/subject/drilling/drilling_chart.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

namespace haptrial::subject {
namespace {

/// Bone from w = 10 mm on; its clearance is the distance to a plane at `danger`.
DrillingChart slab(double danger) {
  DrillingChart chart;
  chart.size = {41, 41, 61};
  chart.end = {10e-3, 10e-3, 25e-3};
  chart.floor_radius = 3e-3;
  chart.slope = 0.5;
  chart.surface.assign(chart.columns(), 10e-3F);
  for (int k = 0; k < 61; ++k) {
    const auto away = static_cast<float>(danger - k * chart.cell);
    chart.clearance.insert(chart.clearance.end(), chart.columns(), away);
  }
  return chart;
}

TEST(DrillingChartTest, PlacesGoThereAndBack) {
  DrillingChart chart = slab(1.0);
  chart.corner = {0.01, -0.02, 0.03};
  chart.axes = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const Eigen::Vector3d p(0.004, 0.005, 0.006);
  EXPECT_LT((chart.place(chart.world(p)) - p).norm(), 1e-15);
}

TEST(DrillingChartTest, TheCavityIsAConeWhereNothingIsInTheWay) {
  const DrillingChart chart = slab(1.0);
  const std::vector<float> floor = cavity_floor(chart);
  for (int j = 0; j < 41; ++j) {
    for (int i = 0; i < 41; ++i) {
      const double aside = std::hypot(i * 0.5e-3 - 10e-3, j * 0.5e-3 - 10e-3);
      const double cone = 25e-3 - std::max(0.0, aside - 3e-3) / 0.5;
      EXPECT_NEAR(static_cast<double>(floor[chart.column(i, j)]), std::max(10e-3, cone), 0.51e-3);
    }
  }
}

TEST(DrillingChartTest, TheCavityEndsAtTheMarginOfAStructure) {
  const DrillingChart chart = slab(18e-3);
  CavityView view;
  EXPECT_NEAR(static_cast<double>(cavity_floor(chart)[chart.column(20, 20)]), 18e-3, 0.6e-3);
  view.extra = 2e-3;
  EXPECT_NEAR(static_cast<double>(cavity_floor(chart, view)[chart.column(20, 20)]), 16e-3, 0.6e-3);
  view.extra = 0.0;
  view.offset.z() = 3e-3;  // believed deeper than it is
  EXPECT_NEAR(static_cast<double>(cavity_floor(chart, view)[chart.column(20, 20)]), 21e-3, 0.6e-3);
}

TEST(DrillingChartTest, WhereThereIsNoBoneThereIsNoFloor) {
  DrillingChart chart = slab(1.0);
  chart.surface[chart.column(20, 20)] = DrillingChart::kNone;
  EXPECT_EQ(cavity_floor(chart)[chart.column(20, 20)], DrillingChart::kNone);
}

TEST(DrillingChartTest, ABurrWithinItsLimitNowhereGoesThroughTheFloor) {
  const DrillingChart chart = slab(19e-3);
  const std::vector<float> floor = cavity_floor(chart);
  constexpr double kRadius = 3e-3;
  const BurrReach reach = burr_reach(chart, floor, kRadius);
  for (int j = 0; j < 41; ++j) {
    for (int i = 0; i < 41; ++i) {
      const auto centre = static_cast<double>(reach.centre[chart.column(i, j)]);
      bool touches = false;
      for (int y = 0; y < 41; ++y) {
        for (int x = 0; x < 41; ++x) {
          const double left = kRadius * kRadius - 0.25e-6 * ((x - i) * (x - i) + (y - j) * (y - j));
          if (left >= 0.0) {
            const double room =
                static_cast<double>(floor[chart.column(x, y)]) - centre - std::sqrt(left);
            EXPECT_GE(room, -1e-8);
            touches = touches || room < 1e-8;
          }
        }
      }
      EXPECT_TRUE(touches) << "could go deeper at " << i << ", " << j;
      EXPECT_LE(reach.floor[chart.column(i, j)], floor[chart.column(i, j)] + 1e-8F);
    }
  }
}

}  // namespace
}  // namespace haptrial::subject
