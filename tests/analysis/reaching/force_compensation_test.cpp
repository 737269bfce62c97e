#include "analysis/reaching/force_compensation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "analysis/reaching/reach_metrics.h"
#include "core/base/random.h"
#include "tests/analysis/reaching/recorded.h"

namespace haptrial::analysis {
namespace {

using Eigen::Vector3d;

constexpr double kViscosity = 13.0;  // [N·s/m]

Eigen::Matrix3d curl() {
  Eigen::Matrix3d field = Eigen::Matrix3d::Zero();
  field(0, 2) = kViscosity;
  field(2, 0) = -kViscosity;
  return field;
}

struct Channel {
  double stiffness, damping;  // [N/m], [N·s/m]
};

/// A hand of 1 kg on a minimum-jerk reach (0.1 m in 0.5 s) along `angle`, that presses sideways
/// with `share` of what the curl field would need, against the wall of a channel.
test::Recorded clamped(double share, double angle, const Channel& channel) {
  const Vector3d to{0.1 * std::sin(angle), 0.0, -0.1 * std::cos(angle)};
  test::Recorded r = test::straight({0.0, 0.0, 0.0}, to);
  const Vector3d left{-std::cos(angle), 0.0, -std::sin(angle)};
  const double step = 1e-5;
  double x = 0.0, v = 0.0;  // sideways
  for (std::size_t i = 0; i < r.time.size(); ++i) {
    const double push = -share * left.dot(curl() * r.velocity[i]);
    const auto wall = [&] { return -channel.stiffness * x - channel.damping * v; };
    r.force.push_back(wall() * left);
    for (int k = 0; k < 100; ++k) {
      v += step * (push + wall());
      x += step * v;
    }
  }
  return r;
}

TEST(ForceCompensationTest, ItIsTheShareThatTheHandCompensates) {
  for (const double angle : {0.0, 1.0, -2.4}) {
    for (const double share : {0.0, 0.3, 1.0, 1.2}) {
      const test::Recorded r = clamped(share, angle, {1e5, 600.0});
      const ReachMetrics m = reach_metrics(r.reach());
      const auto c = force_compensation(r.reach(), curl(), *m.onset, *m.end);
      if (share == 0.0) {
        EXPECT_FALSE(c) << "no force varies";
        continue;
      }
      ASSERT_TRUE(c);
      // The wall gives by f / k, which takes m ω² / k of the force: 0.3 % at 3 Hz.
      EXPECT_NEAR(c->slope, share, 0.01 * share) << angle;
      EXPECT_NEAR(c->intercept, 0.0, 0.02);
      EXPECT_GT(c->r_squared, 0.99);
    }
  }
}

TEST(ForceCompensationTest, TheShippedChannelGivesAlittle) {
  const test::Recorded r = clamped(1.0, 0.0, {2000.0, 30.0});
  const ReachMetrics m = reach_metrics(r.reach());
  const auto c = force_compensation(r.reach(), curl(), *m.onset, *m.end);
  RecordProperty("slope", std::to_string(c->slope));
  EXPECT_NEAR(c->slope, 1.0, 1.0 * std::pow(2.0 * 3.1415927 * 3.0, 2) / 2000.0);  // m ω² / k
}

TEST(ForceCompensationTest, ALineIsFound) {
  std::vector<double> ideal, measured;
  for (int i = 0; i < 50; ++i) {
    ideal.push_back(std::sin(0.1 * i));
    measured.push_back(0.25 + 0.6 * ideal.back());
  }
  const auto c = force_compensation(measured, ideal, 5);
  EXPECT_NEAR(c->slope, 0.6, 1e-14);
  EXPECT_NEAR(c->intercept, 0.25, 1e-14);
  EXPECT_NEAR(c->r_squared, 1.0, 1e-14);
  EXPECT_NEAR(c->slope_error, 0.0, 1e-14);
  EXPECT_EQ(c->samples, 50u);
}

/// Mean stated error of the slope over the standard deviation that slopes really have, with noise
/// that is correlated over 10 ms in samples of 1 ms.
double stated_over_real(std::size_t lags) {
  RandomStream random(5, "noise of a clamp");
  constexpr int kStudies = 2000;
  constexpr int kSamples = 500;
  double error = 0.0, squares = 0.0;
  for (int study = 0; study < kStudies; ++study) {
    std::vector<double> ideal, measured;
    const double keep = std::exp(-0.1);
    double noise = random.normal();
    for (int i = 0; i < kSamples; ++i) {
      ideal.push_back(test::minimum_jerk_rate(i / double{kSamples}));
      measured.push_back(0.7 * ideal.back() + noise);
      noise = keep * noise + std::sqrt(1.0 - keep * keep) * random.normal();
    }
    const auto c = force_compensation(measured, ideal, lags);
    error += c->slope_error / kStudies;
    squares += std::pow(c->slope - 0.7, 2) / kStudies;
  }
  return error / std::sqrt(squares);
}

TEST(ForceCompensationTest, TheErrorKnowsThatNeighboursAreAlike) {
  const double with = stated_over_real(50), without = stated_over_real(0);
  RecordProperty("stated_over_real_with_memory", std::to_string(with));
  RecordProperty("stated_over_real_without", std::to_string(without));
  EXPECT_GT(with, 0.8);
  EXPECT_LT(with, 1.1);
  // Correlated samples are worth (1 - k) / (1 + k) of independent ones: the error is 1 / 4.47.
  EXPECT_NEAR(without, std::sqrt((1.0 - std::exp(-0.1)) / (1.0 + std::exp(-0.1))), 0.03);
}

TEST(ForceCompensationTest, WhatIsNotDefinedIsSaid) {
  const std::vector<double> same(10, 1.0), few{1.0, 2.0};
  EXPECT_FALSE(force_compensation(same, same, 0));
  EXPECT_FALSE(force_compensation(few, few, 0));
  EXPECT_THROW(force_compensation(same, few, 0), std::invalid_argument);
  const test::Recorded r = test::straight({0.0, 0.0, 0.0}, {0.0, 0.0, -0.1});
  EXPECT_THROW(force_compensation(r.reach(), curl(), 0.5, 1.0), std::invalid_argument);
}

}  // namespace
}  // namespace haptrial::analysis
