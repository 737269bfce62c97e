#include "analysis/force_training/score/path_places.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "analysis/force_training/score/score.h"
#include "core/base/random.h"

namespace haptrial::analysis {
namespace {

using Eigen::Vector3d;

constexpr double kSpeed = 0.016;    // [m/s]
constexpr double kDuration = 12.5;  // of the path at its speed [s]

/// A path that goes up and down and crosses itself, at constant speed along its arc.
Vector3d on_path(double time) {
  const double s = time / kDuration * 2.0 * M_PI;
  return {0.045 * std::sin(s), 0.0, 0.03 * std::sin(2.0 * s + 0.3)};
}

std::vector<record::StimulusRow> rows() {
  std::vector<record::StimulusRow> result;
  for (int i = 0; i <= 1250; ++i) {
    result.push_back({1, 0.01 * i, on_path(0.01 * i), 0.0});
  }
  return result;
}

double force_at(double along) { return 5.0 + 4.0 * std::sin(1.1 * along); }

/// Places along the way of a hand whose speed varies between a third and twice the path's.
std::vector<double> uneven_way() {
  std::vector<double> along;
  for (double t = 0.0, place = 0.0; place < kDuration; t += 1e-3) {
    along.push_back(place);
    place += 1e-3 * (1.15 + 0.85 * std::sin(2.0 * t));
  }
  return along;
}

TEST(PathPlacesTest, FindsWhereTheHandWas) {
  const PathPlaces path(rows());
  EXPECT_EQ(path.duration(), 12.5);
  std::vector<Vector3d> positions;
  const std::vector<double> way = uneven_way();
  for (const double along : way) {
    positions.push_back(on_path(along));
  }
  HandPlaces places = path.of(positions);
  for (std::size_t i = 0; i < way.size(); ++i) {
    ASSERT_NEAR(places.along[i], way[i], 2e-4) << "through the crossing too";
    ASSERT_LT(places.distance[i], 1e-6);
  }
  for (std::size_t i = 0; i < way.size(); ++i) {
    const Vector3d along = (on_path(way[i] + 1e-4) - on_path(way[i] - 1e-4)).normalized();
    positions[i] += 5e-4 * along.cross(Vector3d::UnitY()) + 3e-3 * Vector3d::UnitY();
  }
  places = path.of(positions);
  for (std::size_t i = 200; i + 200 < way.size(); ++i) {
    ASSERT_NEAR(places.along[i], way[i], 0.02);
    ASSERT_NEAR(places.distance[i], 5e-4, 2e-6) << "the direction of the force is left out";
  }
}

TEST(PathPlacesTest, APathNeedsTwoRows) {
  EXPECT_THROW(PathPlaces(std::vector<record::StimulusRow>(1)), std::invalid_argument);
}

TEST(OverPathTest, AForceOfThePlaceIsTheSameAtAnyPace) {
  std::vector<double> force;
  const std::vector<double> way = uneven_way();
  for (const double along : way) {
    force.push_back(force_at(along));
  }
  const ForceCurve curve = over_path(way, force, kDuration);
  EXPECT_NEAR(static_cast<double>(curve.force.size() - 1) / curve.rate, kDuration, 1e-9);
  for (std::size_t k = 0; k < curve.force.size(); ++k) {
    const double along = static_cast<double>(k) / curve.rate;
    // A cell is 5 ms wide and its mean may lie anywhere in it: slope 4.4 N/s.
    ASSERT_NEAR(curve.force[k], force_at(along), 4.4 * 0.0026 + 1e-3);
  }
}

TEST(OverPathTest, AScoreDoesNotKnowThePace) {
  // The same mistakes at the same places score the same, fast or slow.
  const auto score_at = [](double speed) {
    std::vector<double> along, target, applied;
    for (double place = 0.0; place <= kDuration; place += 1e-3 * speed) {
      along.push_back(place);
      target.push_back(force_at(place));
      applied.push_back(force_at(place - 0.3) + 0.5);
    }
    return score_recall(over_path(along, target, kDuration), over_path(along, applied, kDuration),
                        {});
  };
  const RecallScore slow = score_at(0.4);
  const RecallScore even = score_at(1.0);
  const RecallScore fast = score_at(2.5);
  EXPECT_GT(even.score, 0.3);
  EXPECT_NEAR(slow.score, even.score, 0.01 * even.score);
  EXPECT_NEAR(fast.score, even.score, 0.01 * even.score);
}

TEST(OverPathTest, WhatWasAppliedAtAPlaceIsTheMeanOverItsTicks) {
  // One second of rest at 1 s with another force than before; then on.
  std::vector<double> along, force;
  for (int i = 0; i <= 2000; ++i) {
    along.push_back(1e-3 * i);
    force.push_back(2.0);
    if (i == 1000) {
      along.insert(along.end(), 999, 1.0);
      force.insert(force.end(), 999, 4.0);
    }
  }
  const ForceCurve curve = over_path(along, force, 2.0);
  const auto at = static_cast<std::size_t>(std::lround(1.0 * curve.rate));
  EXPECT_GT(curve.force[at], 3.9);
  EXPECT_EQ(curve.force[at - 2], 2.0);
  EXPECT_EQ(curve.force[at + 2], 2.0);
}

TEST(OverPathTest, SkippedCellsAreBridgedAndTheEndsHeld) {
  const std::vector<double> along{0.5, 1.5};
  const std::vector<double> force{1.0, 3.0};
  const ForceCurve curve = over_path(along, force, 2.0);
  const auto at = [&](double place) {
    return curve.force[static_cast<std::size_t>(std::lround(place * curve.rate))];
  };
  EXPECT_EQ(at(0.0), 1.0);
  EXPECT_EQ(at(0.5), 1.0);
  EXPECT_NEAR(at(1.0), 2.0, 1e-9);
  EXPECT_NEAR(at(1.25), 2.5, 1e-9);
  EXPECT_EQ(at(2.0), 3.0);
  EXPECT_THROW(over_path(along, std::vector<double>{1.0}, 2.0), std::invalid_argument);
  EXPECT_THROW(over_path(std::vector<double>{}, std::vector<double>{}, 2.0), std::invalid_argument);
}

}  // namespace
}  // namespace haptrial::analysis
