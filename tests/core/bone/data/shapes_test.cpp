#include "core/bone/data/shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/base/random.h"

namespace haptrial::bone {
namespace {

TEST(ShapesTest, TurnsAreCosineAndSine) {
  for (double angle = -6.2; angle < 6.3; angle += 0.1) {
    EXPECT_NEAR(turn_by(angle).cosine, std::cos(angle), 1e-12);
    EXPECT_NEAR(turn_by(angle).sine, std::sin(angle), 1e-12);
  }
}

TEST(ShapesTest, ATubeOfEqualRadiusIsAsFarAsItsLineLessThatRadius) {
  const Tube worm({{{0, 0, 0}, 1.0}, {{4, 0, 0}, 1.0}, {{4, 3, 0}, 1.0}});
  EXPECT_DOUBLE_EQ(worm.length(), 7.0);
  EXPECT_DOUBLE_EQ(worm.distance({2, 0, 2.5}), 1.5);
  EXPECT_DOUBLE_EQ(worm.distance({4, 3, 0}), -1.0);
  RandomStream random(3, "worm");
  for (int i = 0; i < 2000; ++i) {
    const Point p(random.uniform(-4, 8), random.uniform(-4, 7), random.uniform(-4, 4));
    double exact = 1e9;
    for (double t = 0.0; t <= 1.0; t += 1.0 / 1024) {
      exact = std::min({exact, (p - Point(4 * t, 0, 0)).norm(), (p - Point(4, 3 * t, 0)).norm()});
    }
    const double found = worm.distance(p, 1e9);
    EXPECT_NEAR(found, exact - 1.0, 5e-3);
    // With less care it may be less, but stays on its side of it.
    const double quick = worm.distance(p, 1.0);
    EXPECT_LE(quick, found + 1e-12);
    EXPECT_EQ(quick > 1.0, found > 1.0 && quick > 1.0);
  }
}

TEST(ShapesTest, ARoundedUnionLiesBelowBothAndMeetsThemAway) {
  EXPECT_DOUBLE_EQ(smooth_union(1.0, 5.0, 2.0), 1.0);
  EXPECT_DOUBLE_EQ(smooth_union(1.0, 1.0, 2.0), 0.5);
  EXPECT_LE(smooth_union(0.3, 0.9, 2.0), 0.3);
}

TEST(ShapesTest, BubblesHaveWallsBetweenThem) {
  const Cells cells(9, 3.0, 0.4);
  int air = 0;
  const int count = 20000;
  RandomStream random(4, "cells");
  for (int i = 0; i < count; ++i) {
    const Point p(random.uniform(0, 60), random.uniform(0, 60), random.uniform(0, 60));
    air += cells.holds(p, 1.0);
    EXPECT_FALSE(cells.holds(p, 0.0));
  }
  EXPECT_GT(air, count / 5);
  EXPECT_LT(air, count * 4 / 5);
}

}  // namespace
}  // namespace haptrial::bone
