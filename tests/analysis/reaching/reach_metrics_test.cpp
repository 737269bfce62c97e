#include "analysis/reaching/reach_metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "tests/analysis/reaching/recorded.h"

namespace haptrial::analysis {
namespace {

using Eigen::Vector3d;
using test::Recorded;

constexpr double kDistance = 0.1;
constexpr double kDuration = 0.5;
constexpr double kBegin = 0.5;

/// Time at which a minimum-jerk reach rises above (or, mirrored, falls below) a speed, after its
/// begin.
double time_of_speed(double speed) {
  double low = 0.0, high = 0.5;
  for (int i = 0; i < 60; ++i) {
    const double s = 0.5 * (low + high);
    const bool slow = kDistance / kDuration * test::minimum_jerk_rate(s) < speed;
    (slow ? low : high) = s;
  }
  return low * kDuration;
}

TEST(ReachMetricsTest, AMinimumJerkReachHasItsClosedForm) {
  const Recorded r = test::straight({0.0, 0.0, 0.0}, {0.0, 0.0, -kDistance});
  const ReachMetrics m = reach_metrics(r.reach());
  ASSERT_TRUE(m.flags.sound());
  const double rise = time_of_speed(0.03), fall = kDuration - time_of_speed(0.05);
  constexpr double kInterpolation = 1e-5;  // of a speed curved within a millisecond [s]
  EXPECT_NEAR(*m.onset, kBegin + rise, kInterpolation);
  EXPECT_NEAR(*m.end, kBegin + fall, kInterpolation);
  EXPECT_NEAR(*m.reaction_time, kBegin + rise - r.go, kInterpolation);
  EXPECT_NEAR(*m.movement_time, fall - rise, kInterpolation);
  EXPECT_NEAR(*m.peak_speed, 1.875 * kDistance / kDuration, 1e-12);
  EXPECT_NEAR(*m.time_to_peak, 0.5 * kDuration - rise, kInterpolation);
  EXPECT_NEAR(
      *m.path_length,
      kDistance * (test::minimum_jerk(fall / kDuration) - test::minimum_jerk(rise / kDuration)),
      1e-6);
  EXPECT_NEAR(*m.endpoint_extent, kDistance * (test::minimum_jerk(fall / kDuration) - 1.0), 1e-6);
  EXPECT_NEAR(*m.endpoint_error, std::abs(*m.endpoint_extent), 1e-15);
  EXPECT_EQ(*m.maximum_perpendicular_error, 0.0);
  EXPECT_EQ(*m.signed_area, 0.0);
  EXPECT_EQ(*m.direction_error, 0.0);
  EXPECT_FALSE(m.mean_lateral_force);
}

TEST(ReachMetricsTest, AnArcHasTheAreaOfItsSegment) {
  constexpr double kAngle = 0.8;
  const Recorded r = test::arc(kDistance, kAngle);
  MetricOptions options;
  options.movement = {1e-6, 0.1, 1e-6, 0.1};  // the whole way
  const ReachMetrics m = reach_metrics(r.reach(), options);
  ASSERT_TRUE(m.flags.sound());
  const double radius = 0.5 * kDistance / std::sin(0.5 * kAngle);
  EXPECT_NEAR(*m.signed_area, 0.5 * radius * radius * (kAngle - std::sin(kAngle)), 1e-8);
  EXPECT_NEAR(*m.maximum_perpendicular_error, radius * (1.0 - std::cos(0.5 * kAngle)), 1e-9);
  EXPECT_NEAR(*m.path_length, radius * kAngle, 1e-7);
  // The direction from the begin of an arc to a point of it is the chord's, turned by half of the
  // angle that is left.
  const double done = kAngle * test::minimum_jerk((*m.onset + 0.15 - kBegin) / kDuration);
  EXPECT_NEAR(*m.direction_error, 0.5 * (kAngle - done), 1e-4);
}

TEST(ReachMetricsTest, AReachAtAnAngleHasThatDirection) {
  for (const double angle : {-1.0, -0.2, 0.35, 2.5}) {
    const Vector3d to{-kDistance * std::sin(angle), 0.0, -kDistance * std::cos(angle)};
    Recorded r = test::straight({0.0, 0.0, 0.0}, to);
    r.target = {0.0, 0.0, -kDistance};
    const ReachMetrics m = reach_metrics(r.reach());
    EXPECT_NEAR(*m.direction_error, angle, 1e-12) << "counterclockwise from above is positive";
    EXPECT_TRUE(m.flags.missed_target);
  }
}

TEST(ReachMetricsTest, LeftIsTheParticipantsLeft) {
  const WayFrame frame({0.0, 0.0, 0.0}, {0.0, 0.0, -1.0});
  EXPECT_NEAR((frame.left() - Vector3d(-1.0, 0.0, 0.0)).norm(), 0.0, 1e-15);
  EXPECT_THROW(WayFrame({0.0, 0.0, 0.0}, {0.0, 1.0, 0.0}), std::invalid_argument);
}

TEST(ReachMetricsTest, TurningTheRoomChangesNothingAndAMirrorTheSigns) {
  Recorded r = test::arc(kDistance, 1.1);
  for (std::size_t i = 0; i < r.time.size(); ++i) {
    r.force.emplace_back(-2.0 * std::sin(r.time[i]), 0.3, r.time[i]);
  }
  const ReachMetrics m = reach_metrics(r.reach());
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(2.1, Vector3d::UnitY()).toRotationMatrix();
  const ReachMetrics turned = reach_metrics(test::transformed(r, turn).reach());
  Eigen::Matrix3d mirror = Eigen::Matrix3d::Identity();
  mirror(0, 0) = -1.0;
  const ReachMetrics mirrored = reach_metrics(test::transformed(r, mirror).reach());
  for (const auto member : {&ReachMetrics::maximum_perpendicular_error, &ReachMetrics::signed_area,
                            &ReachMetrics::direction_error, &ReachMetrics::mean_lateral_force,
                            &ReachMetrics::peak_lateral_force}) {
    EXPECT_NE(*(m.*member), 0.0);
    EXPECT_NEAR(*(turned.*member), *(m.*member), 1e-12);
    EXPECT_NEAR(*(mirrored.*member), -*(m.*member), 1e-12);
  }
  for (const auto member : {&ReachMetrics::onset, &ReachMetrics::movement_time,
                            &ReachMetrics::path_length, &ReachMetrics::endpoint_error}) {
    EXPECT_NEAR(*(turned.*member), *(m.*member), 1e-12);
    EXPECT_NEAR(*(mirrored.*member), *(m.*member), 1e-12);
  }
}

TEST(ReachMetricsTest, TheMeanForceIsItsImpulseOverTheMovementTime) {
  Recorded r = test::straight({0.0, 0.0, 0.0}, {0.0, 0.0, -kDistance});
  for (std::size_t i = 0; i < r.time.size(); ++i) {
    r.force.emplace_back(7.0 * r.velocity[i].z(), 0.0, 0.0);  // to the left: -x · -z
  }
  const ReachMetrics m = reach_metrics(r.reach());
  EXPECT_NEAR(*m.mean_lateral_force, 7.0 * *m.path_length / *m.movement_time, 1e-5);
  EXPECT_NEAR(*m.peak_lateral_force, 7.0 * *m.peak_speed, 1e-12);
}

TEST(ReachMetricsTest, APerpendicularErrorIsReadAtItsTime) {
  const Recorded r = test::arc(kDistance, 0.8);
  const ReachMetrics m = reach_metrics(r.reach());
  EXPECT_NEAR(*perpendicular_error_at(r.reach(), m, *m.time_to_peak),
              *m.maximum_perpendicular_error, 1e-6);
  EXPECT_FALSE(perpendicular_error_at(r.reach(), m, 10.0));
}

TEST(ReachMetricsTest, ATwitchBeforeTheReachIsNoOnset) {
  Recorded r = test::straight({0.0, 0.0, 0.0}, {0.0, 0.0, -kDistance});
  for (std::size_t i = 0; i < r.time.size(); ++i) {
    if (r.time[i] > 0.3 && r.time[i] < 0.32) {
      r.velocity[i].x() = 0.034;  // below a tenth of the peak speed, 0.0375 m/s
    }
  }
  MetricOptions options;
  EXPECT_NEAR(*reach_metrics(r.reach(), options).onset, kBegin + time_of_speed(0.03), 1e-5);
  options.movement.search_from = 0.0;
  EXPECT_NEAR(*reach_metrics(r.reach(), options).onset, 0.3, 2e-3);
}

TEST(ReachMetricsTest, ACorrectionBelongsToTheReach) {
  Recorded r = test::straight({0.0, 0.0, 0.0}, {0.0, 0.0, -kDistance});
  // Shortly after the first stop a second, small movement.
  const double first_stop = kBegin + kDuration - time_of_speed(0.05);
  for (std::size_t i = 0; i < r.time.size(); ++i) {
    if (r.time[i] > first_stop + 0.06 && r.time[i] < first_stop + 0.12) {
      r.velocity[i].z() = -0.06;
    }
  }
  const ReachMetrics m = reach_metrics(r.reach());
  EXPECT_NEAR(*m.end, first_stop + 0.12, 2e-3);
  MetricOptions hasty;
  hasty.movement.end_hold = 0.02;
  EXPECT_NEAR(*reach_metrics(r.reach(), hasty).end, first_stop, 1e-5);
}

TEST(ReachMetricsTest, WhatIsWrongWithAReachIsFlagged) {
  const Recorded good = test::straight({0.0, 0.0, 0.0}, {0.0, 0.0, -kDistance});
  Recorded still = good;
  std::ranges::fill(still.velocity, Vector3d::Zero());
  EXPECT_TRUE(reach_metrics(still.reach()).flags.no_onset);
  EXPECT_FALSE(reach_metrics(still.reach()).peak_speed);

  Recorded cut = good;
  const std::size_t half = 750;  // at the peak
  cut.time.resize(half);
  cut.position.resize(half);
  cut.velocity.resize(half);
  const ReachMetrics never = reach_metrics(cut.reach());
  EXPECT_TRUE(never.flags.never_slowed);
  EXPECT_FALSE(never.end || never.movement_time || never.endpoint_error);
  EXPECT_TRUE(never.path_length && never.peak_speed);

  Recorded moving = good;
  std::ranges::fill(moving.velocity, Vector3d(0.04, 0.0, 0.0));
  EXPECT_TRUE(reach_metrics(moving.reach()).flags.moving_at_start);

  Recorded early = good;
  early.go = kBegin + 0.2;
  EXPECT_TRUE(reach_metrics(early.reach()).flags.anticipated);
  EXPECT_LT(*reach_metrics(early.reach()).reaction_time, 0.0);

  Recorded far = good;
  far.target = {0.0, 0.0, -0.2};
  EXPECT_TRUE(reach_metrics(far.reach()).flags.missed_target);

  Recorded gap = good;
  gap.position[10].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(reach_metrics(gap.reach()).flags.not_finite);
  EXPECT_FALSE(reach_metrics(gap.reach()).onset);

  Recorded late = good;
  late.go = 100.0;
  EXPECT_TRUE(reach_metrics(late.reach()).flags.no_onset);
}

/// The rounding of a straight reach at an angle is no error of the hand.
TEST(ReachMetricsTest, AStraightReachHasNoErrorAtAnyAngle) {
  for (int i = 0; i < 32; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / 32.0;
    const Eigen::Vector3d target(0.06 * std::cos(angle), 0.0, -0.06 * std::sin(angle));
    const ReachMetrics metrics = reach_metrics(test::straight({0.0, 0.0, 0.0}, target).reach());
    ASSERT_TRUE(metrics.maximum_perpendicular_error) << angle;
    EXPECT_EQ(*metrics.maximum_perpendicular_error, 0.0) << angle;
  }
}

TEST(ReachMetricsTest, BadArgumentsAreNamed) {
  Recorded r = test::straight({0.0, 0.0, 0.0}, {0.0, 0.0, -kDistance});
  MetricOptions options;
  options.movement.onset_speed = 0.0;
  EXPECT_THROW(reach_metrics(r.reach(), options), std::invalid_argument);
  r.velocity.pop_back();
  EXPECT_THROW(reach_metrics(r.reach()), std::invalid_argument);
  Recorded back = test::straight({0.0, 0.0, 0.0}, {0.0, 0.0, -kDistance});
  std::swap(back.time[3], back.time[4]);
  EXPECT_THROW(reach_metrics(back.reach()), std::invalid_argument);
}

}  // namespace
}  // namespace haptrial::analysis
