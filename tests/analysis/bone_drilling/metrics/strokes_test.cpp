// Strokes of known number, length, speed and smoothness.

#include "analysis/bone_drilling/metrics/strokes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/analysis/bone_drilling/hand_made.h"

namespace haptrial::analysis::drilling {
namespace {

/// A way from 0 to 1 with the least jerk. Source: Flash and Hogan 1985.
double minimum_jerk(double s) { return s * s * s * (10.0 + s * (-15.0 + 6.0 * s)); }
double minimum_jerk_rate(double s) { return s * s * (30.0 + s * (-60.0 + 30.0 * s)); }

void stay(Procedure& p, double seconds, bool in_bone) {
  const Eigen::Vector3d where = p.ticks.empty() ? Eigen::Vector3d::Zero() : p.ticks.back().position;
  const auto ticks = std::llround(seconds * p.rate);
  for (int i = 0; i < ticks; ++i) {
    ToolTick tick = test::drilling_tick(p.ticks.size(), where);
    tick.in_bone = in_bone;
    p.ticks.push_back(tick);
  }
}

void move(Procedure& p, const Eigen::Vector3d& by, double seconds, bool in_bone = true) {
  const Eigen::Vector3d from = p.ticks.empty() ? Eigen::Vector3d::Zero() : p.ticks.back().position;
  const auto ticks = std::llround(seconds * p.rate);
  for (int i = 1; i <= ticks; ++i) {
    const double s = static_cast<double>(i) / static_cast<double>(ticks);
    ToolTick tick = test::drilling_tick(p.ticks.size(), from + minimum_jerk(s) * by);
    tick.velocity = minimum_jerk_rate(s) / seconds * by;
    tick.in_bone = in_bone;
    p.ticks.push_back(tick);
  }
}

Procedure nothing_yet() { return test::procedure_on(test::block(2, 2, 2)); }

const Eigen::Vector3d kX = Eigen::Vector3d::UnitX();

TEST(StrokesTest, ThereAndBackAreTwoEach) {
  Procedure p = nothing_yet();
  for (int n = 0; n < 7; ++n) {
    move(p, (n % 2 == 0 ? 8e-3 : -8e-3) * kX, 0.4);
  }
  const std::vector<Stroke> strokes = find_strokes(p);
  ASSERT_EQ(strokes.size(), 7u);
  for (const Stroke& stroke : strokes) {
    EXPECT_NEAR(stroke.length, 8e-3, 2e-5);
    EXPECT_NEAR(stroke.duration, 0.4, 0.01);
    EXPECT_NEAR(stroke.speed, 0.02, 6e-4);
  }
  const StrokeFigures figures = stroke_figures(p);
  EXPECT_EQ(figures.count, 7u);
  EXPECT_NEAR(*figures.rate, 2.5, 1e-9) << "7 strokes in 2.8 s";
}

TEST(StrokesTest, ALiftEndsAStroke) {
  Procedure p = nothing_yet();
  move(p, 5e-3 * kX, 0.3);
  stay(p, 0.2, false);
  move(p, 5e-3 * kX, 0.3);  // the same way
  EXPECT_EQ(find_strokes(p).size(), 2u);
  EXPECT_EQ(find_strokes(p, {.lift = 0.25}).size(), 1u);
  EXPECT_NEAR(*stroke_figures(p).rate, 2.0 / 0.6, 1e-9) << "the air is no drilling";
}

TEST(StrokesTest, OnlyDrillingCounts) {
  Procedure p = nothing_yet();
  move(p, 5e-3 * kX, 0.3);
  const Procedure drilled = p;
  EXPECT_EQ(find_strokes(drilled).size(), 1u);
  const auto without = [&](auto&& change) {
    Procedure other = drilled;
    for (ToolTick& tick : other.ticks) {
      change(tick);
    }
    return find_strokes(other).size();
  };
  EXPECT_EQ(without([](ToolTick& tick) { tick.power = false; }), 0u);
  EXPECT_EQ(without([](ToolTick& tick) { tick.in_bone = false; }), 0u);
  EXPECT_EQ(without([](ToolTick& tick) { tick.drives_tool = false; }), 0u);
  EXPECT_EQ(without([](ToolTick& tick) { tick.tool = 1; }), 0u) << "no burr";
  EXPECT_FALSE(stroke_figures(nothing_yet()).rate);
  EXPECT_FALSE(stroke_figures(nothing_yet()).length);
}

TEST(StrokesTest, ATrembleIsNoReversalAndNoStroke) {
  RandomStream random(4, "tremble");
  Procedure p = nothing_yet();
  stay(p, 1.0, true);
  move(p, 10e-3 * kX, 0.5);
  for (ToolTick& tick : p.ticks) {
    for (int axis = 0; axis < 3; ++axis) {
      tick.position[axis] += random.uniform(-1e-4, 1e-4);
    }
  }
  EXPECT_EQ(find_strokes(p).size(), 1u);
}

TEST(StrokesTest, ACircleIsTwoStrokesARound) {
  Procedure p = nothing_yet();
  for (int i = 0; i < 3000; ++i) {  // three rounds of 1 s, radius 3 mm
    const double angle = 2.0 * M_PI * i / 1000.0;
    p.ticks.push_back(
        test::drilling_tick(static_cast<std::uint64_t>(i),
                            3e-3 * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0)));
  }
  const std::vector<Stroke> strokes = find_strokes(p);
  ASSERT_GE(strokes.size(), 5u);
  ASSERT_LE(strokes.size(), 6u);
  EXPECT_NEAR(strokes[1].length, M_PI * 3e-3, 2e-4) << "half a round";
}

TEST(StrokesTest, AMinimumJerkStrokeHasItsSmoothness) {
  // Integral of jerk^2 = 720 D^2 / T^5 and v_peak = 15/8 D / T: -ln(720 / (15/8)^2) = -5.32,
  // whatever D and T.
  for (const double seconds : {0.6, 1.0}) {
    for (const double metres : {3e-3, 12e-3}) {
      Procedure p = nothing_yet();
      stay(p, 0.2, false);
      move(p, metres * kX, seconds);
      stay(p, 0.2, false);
      const std::vector<Stroke> strokes = find_strokes(p);
      ASSERT_EQ(strokes.size(), 1u);
      const double exact = -std::log(720.0 / (1.875 * 1.875));
      // At both ends of the movement its jerk jumps, and a step takes the mean over that.
      EXPECT_NEAR(*strokes[0].smoothness, exact, 0.2);
      EXPECT_NEAR(*find_strokes(p, {.step = 0.002})[0].smoothness, exact, 0.05);
    }
  }
}

TEST(StrokesTest, AJerkyStrokeIsLessSmooth) {
  Procedure smooth = nothing_yet();
  move(smooth, 10e-3 * kX, 0.8);
  Procedure halting = nothing_yet();
  for (int n = 0; n < 4; ++n) {
    move(halting, 2.5e-3 * kX, 0.2);
  }
  ASSERT_EQ(find_strokes(halting).size(), 1u);
  // Four movements of a quarter: jerk^2 as of one that takes a quarter of the time, over (D/4)^2.
  // (0.8 / 0.2)^3 times as much for the same peak speed, and four of them: ln 256.
  EXPECT_NEAR(*find_strokes(smooth)[0].smoothness - *find_strokes(halting)[0].smoothness,
              std::log(256.0), 0.6);
  Procedure dab = nothing_yet();
  move(dab, 2e-3 * kX, 0.045);
  ASSERT_EQ(find_strokes(dab).size(), 1u);
  EXPECT_FALSE(find_strokes(dab)[0].smoothness);
}

TEST(StrokesTest, RefusesBadParameters) {
  EXPECT_THROW(find_strokes(nothing_yet(), {.turn_back = 0.0}), std::invalid_argument);
  EXPECT_THROW(find_strokes(nothing_yet(), {.step = -0.1}), std::invalid_argument);
}

}  // namespace
}  // namespace haptrial::analysis::drilling
