#include "core/control/curve_tracker.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "core/base/random.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/neighbour_method.h"

namespace haptrial::control {
namespace {

using Eigen::Vector3d;
using Points = std::vector<Vector3d>;

/// A figure of eight, 0.1 m wide, that crosses itself in the origin at right angles.
Points figure_of_eight(std::size_t count = 4001) {
  Points points;
  for (std::size_t i = 0; i < count; ++i) {
    const double a = 2.0 * M_PI * static_cast<double>(i) / static_cast<double>(count - 1) + 0.7;
    points.push_back({0.05 * std::sin(a), 0.0, 0.025 * std::sin(2.0 * a)});
  }
  return points;
}

/// Two straight strands, `gap` apart, joined at one end.
Points hairpin(double gap) { return {{0, 0, 0}, {0.1, 0, 0}, {0.1, 0, gap}, {0, 0, gap}}; }

Vector3d wobble(double t, double size) {
  return {size * std::sin(5.0 * t), size * std::sin(3.0 * t + 1.0), size * std::cos(7.0 * t)};
}

TEST(CurveTrackerTest, GoesThroughACrossingWithoutAJump) {
  const SampledCurve curve(figure_of_eight());
  CurveTracker tracker(curve);
  int nearest_jumped = 0;
  double before = 0.0;
  double nearest_before = 0.0;
  for (double arc = 0.0; arc < curve.length(); arc += 1.6e-5) {
    const Vector3d tool = curve.at(arc).position + wobble(arc / 0.016, 0.002);
    const CurvePlace place = tracker.follow(tool);
    ASSERT_LT(std::abs(place.arc - before), 0.001) << arc;
    ASSERT_LT(std::abs(place.arc - arc), 0.005) << arc;
    before = place.arc;
    const double nearest = curve.nearest(tool).arc;
    nearest_jumped += std::abs(nearest - nearest_before) > 0.02;
    nearest_before = nearest;
  }
  EXPECT_GT(before, curve.length() - 0.005);
  EXPECT_GE(nearest_jumped, 2) << "without continuity it would have jumped";
}

TEST(CurveTrackerTest, StaysOnItsStrandBesideANearerOne) {
  // Figure 46: the tool strays onto the other strand, which runs 2 mm away.
  const SampledCurve curve(hairpin(0.002));
  CurveTracker tracker(curve);
  for (double x = 0.0; x < 0.09; x += 1e-5) {
    const Vector3d tool(x, 0.0, 0.002 * std::sin(200.0 * x) + 0.001);
    tracker.follow(tool);
    ASSERT_NEAR(tracker.place().arc, x, 1e-9);
  }
  tracker.start({0.03, 0.0, 0.0019});
  EXPECT_NEAR(tracker.place().arc, 0.1 + 0.002 + 0.07, 1e-9) << "a start looks everywhere";
  // Round the end it may go, and does so at the speed of the tool.
  tracker.start_at(0.095);
  double before = tracker.place().arc;
  for (double a = -0.5 * M_PI; a < 0.5 * M_PI; a += 0.001) {
    const Vector3d tool =
        Vector3d(0.0995, 0.0, 0.001) + 0.003 * Vector3d(std::cos(a), 0.0, std::sin(a));
    tracker.follow(tool);
    ASSERT_LT(std::abs(tracker.place().arc - before), 0.0055);
    before = tracker.place().arc;
  }
  EXPECT_GT(before, 0.102);
}

/// The rule itself, over every one of many places of the curve.
double by_rule(const SampledCurve& curve, const CurveFollowing& f, double before,
               const Vector3d& tool) {
  double near = std::numeric_limits<double>::infinity();
  double far = near;
  for (int i = -20000; i <= 20000; ++i) {
    const double arc = before + f.reach * i / 20000.0;
    if (arc < 0.0 || arc > curve.length()) {
      continue;
    }
    const double distance = (curve.at(arc).position - tool).norm();
    far = std::min(far, distance);
    near = std::abs(arc - before) <= f.step ? std::min(near, distance) : near;
  }
  return far < near - f.margin ? far : near;
}

TEST(CurveTrackerTest, FollowsTheRuleOnRandomWays) {
  RandomStream random(1, "rule");
  Points points;
  Vector3d walk = Vector3d::Zero();
  for (int i = 0; i < 400; ++i) {
    walk += 6e-4 * Vector3d(random.normal(), random.normal(), random.normal());
    points.push_back(walk);
  }
  const SampledCurve curve(points);
  const CurveFollowing f;
  CurveTracker tracker(curve, f);
  Vector3d tool = points.front();
  int far_moves = 0;
  for (int i = 0; i < 300; ++i) {
    tool += 1e-3 * Vector3d(random.normal(), random.normal(), random.normal());
    tool += 0.05 * (curve.at(curve.length() * i / 300.0).position - tool);
    const double before = tracker.place().arc;
    const CurvePlace place = tracker.follow(tool);
    // The scan sees the curve every 0.25 µm.
    ASSERT_NEAR(place.distance, by_rule(curve, f, before, tool), 3e-7) << i;
    ASSERT_LE(std::abs(place.arc - before), f.reach * (1.0 + 1e-12));
    far_moves += std::abs(place.arc - before) > f.step * (1.0 + 1e-9);
  }
  EXPECT_GT(far_moves, 5);
}

TEST(CurveTrackerTest, WhatItRemembersOfTheCurveAroundChangesNoAnswer) {
  // A tool that moves as a hand does, in small steps past strands that come near each other; beside
  // it a tracker that remembers nothing.
  RandomStream random(5, "memory");
  Points points = figure_of_eight(3000);
  for (Vector3d& p : points) {
    p += 2e-4 * Vector3d(random.normal(), random.normal(), random.normal());
  }
  const SampledCurve curve(points);
  CurveTracker tracker(curve);
  Vector3d off = Vector3d::Zero();
  int far_moves = 0;
  for (int i = 0; i < 30000; ++i) {
    off += 5e-5 * Vector3d(random.normal(), random.normal(), random.normal()) - 0.002 * off;
    const Vector3d tool = curve.at(curve.length() * i / 30000.0).position + off;
    CurveTracker forgetful(curve);
    const double before = curve.arc_of(tracker.place().segment, tracker.place().t);
    forgetful.start_at(before);
    const CurvePlace expected = forgetful.follow(tool);
    const CurvePlace place = tracker.follow(tool);
    ASSERT_NEAR(place.distance, expected.distance, 2.0 * CurveFollowing{}.tolerance) << i;
    ASSERT_NEAR(place.arc, expected.arc, 1e-6) << i;
    far_moves += std::abs(place.arc - before) > CurveFollowing{}.step;
  }
  EXPECT_GT(far_moves, 20) << "there was something to remember wrongly";
}

TEST(CurveTrackerTest, AChangeOfPlaceNeverBringsItFarther) {
  RandomStream random(2, "energy");
  const SampledCurve curve(figure_of_eight(2000));
  CurveTracker tracker(curve);
  Vector3d tool = curve.at(0.0).position;
  for (int i = 0; i < 20000; ++i) {
    const double jump = std::pow(10.0, random.uniform(-6.0, -2.0));
    tool += jump * Vector3d(random.normal(), random.normal(), random.normal()) - 0.01 * tool;
    const Vector3d before = tracker.place().position;
    tracker.follow(tool);
    ASSERT_LE((tool - tracker.place().position).norm(),
              (tool - before).norm() + CurveFollowing{}.tolerance + 1e-15);
  }
}

TEST(CurveTrackerTest, BetweenTwoEqualPlacesItKeepsItsOwn) {
  // On the bisector of a right angle both legs are equally far; noise below the margin does not
  // make the place flutter, and a clear move changes it at once.
  const SampledCurve curve(Points{{0.05, 0, 0}, {0, 0, 0}, {0, 0, 0.05}});
  RandomStream random(3, "bisector");
  CurveTracker tracker(curve);
  tracker.start({0.002, 0.0, 0.0015});
  const double held = tracker.place().arc;
  ASSERT_NEAR(held, 0.048, 1e-9);
  for (int i = 0; i < 1000; ++i) {
    const double noise = 4e-5 * random.uniform(-1.0, 1.0);
    tracker.follow({0.002 + noise, 0.0, 0.002 - noise});
    ASSERT_NEAR(tracker.place().arc, held, 5e-5);
  }
  tracker.follow({0.0018, 0.0, 0.002});
  EXPECT_NEAR(tracker.place().arc, 0.052, 1e-9);
}

TEST(CurveTrackerTest, TheSourcesMethodGoesTheSameWay) {
  test::NeighbourMethod source(figure_of_eight(2000));
  const SampledCurve curve(source.points());
  CurveTracker tracker(curve);
  constexpr double kWeight = 0.01;  // the source's 1, with distances in centimetres [m]
  std::optional<double> before = 0.0;
  for (double arc = 0.0; arc < curve.length(); arc += 4e-4) {
    const Vector3d tool = curve.at(arc).position + wobble(arc / 0.016, 0.001);
    tracker.follow(tool);
    const CurvePlace place = source.place(tool, source.nearest_points(tool, 100), before, kWeight);
    before = place.arc;
    // The penalty holds the place back: on a straight stretch by weight / length of the distance.
    const double drag = 3.0 * kWeight / source.length() * place.distance + 1e-6;
    ASSERT_NEAR(place.arc, tracker.place().arc, drag) << arc;
  }
}

TEST(CurveTrackerTest, FromTheCentreOfACircleAnyPlaceIsNearEnough) {
  Points points;
  for (int i = 0; i < 20000; ++i) {
    const double a = 2.0 * M_PI * i / 20000.0;
    points.push_back({0.03 * std::cos(a), 0.0, 0.03 * std::sin(a)});
  }
  const SampledCurve curve(points);
  CurveTracker tracker(curve);
  tracker.start_at(0.05);
  for (int i = 0; i < 100; ++i) {
    tracker.follow(Vector3d::Zero());
    ASSERT_NEAR(tracker.place().distance, 0.03, 1.1e-9);
  }
  EXPECT_NEAR(tracker.place().arc, 0.05, 0.001) << "and there is no reason to wander";
  EXPECT_NEAR(tracker.start({1e-12, 0.0, 0.0}).distance, 0.03, 1.1e-9);
}

TEST(CurveTrackerTest, AToolThatIsNowhereLeavesThePlace) {
  const SampledCurve curve(hairpin(0.01));
  CurveTracker tracker(curve);
  tracker.start({0.04, 0.0, 0.0});
  const double arc = tracker.place().arc;
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(tracker.follow({bad, 0.0, 0.0}).arc, arc);
    EXPECT_EQ(tracker.start({0.0, bad, 0.0}).arc, arc);
  }
}

TEST(CurveTrackerTest, ParametersOutOfBoundsAreRefusedByName) {
  const SampledCurve curve(hairpin(0.01));
  const auto refused = [&](const CurveFollowing& f, const char* name) {
    try {
      CurveTracker tracker(curve, f);
      FAIL() << name;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find(name), std::string::npos);
    }
  };
  refused({.step = 0.0}, "step");
  refused({.step = 0.01, .reach = 0.005}, "reach");
  refused({.margin = -1.0}, "margin");
  refused({.tolerance = std::numeric_limits<double>::quiet_NaN()}, "tolerance");
}

TEST(CurveTrackerTest, FollowingDoesNotAllocate) {
  const SampledCurve curve(figure_of_eight());
  CurveTracker tracker(curve);
  const test::AllocationGuard guard;
  for (int i = 0; i < 2000; ++i) {
    tracker.follow(curve.at(1e-5 * i).position + wobble(1e-3 * i, 0.003));
  }
  tracker.start({0.01, 0.0, 0.0});
  EXPECT_EQ(guard.count(), 0u);
}

}  // namespace
}  // namespace haptrial::control
