#include "analysis/contact/recording/block_regression.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/base/random.h"

namespace haptrial::evaluation {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// Noise whose neighbours are alike: each sample keeps `memory` of the one before.
Eigen::VectorXd remembered_noise(RandomStream& random, Eigen::Index n, double memory) {
  Eigen::VectorXd noise(n);
  double last = random.normal();
  for (Eigen::Index i = 0; i < n; ++i) {
    last = memory * last + std::sqrt(1.0 - memory * memory) * random.normal();
    noise[i] = last;
  }
  return noise;
}

TEST(BlockRegressionTest, WithoutNoiseTheCoefficientsAreExact) {
  Eigen::MatrixXd x(100, 2);
  for (Eigen::Index i = 0; i < 100; ++i) {
    x.row(i) << 1e6 * std::sin(0.1 * static_cast<double>(i)), 1e-6;
  }
  const Eigen::Vector2d truth(3e-6, -2e6);
  const BlockFit fit = fit_blocks(x, x * truth, {"a", "b"});
  EXPECT_NEAR(fit.coefficients[0] / truth[0], 1.0, 1e-12);
  EXPECT_NEAR(fit.coefficients[1] / truth[1], 1.0, 1e-12);
  EXPECT_THAT(fit.confounded, testing::IsEmpty());
}

/// Neither ordinary standard errors nor intervals of the normal distribution would do here.
TEST(BlockRegressionTest, IntervalsHoldTheTruthWhenNeighboursAreAlike) {
  constexpr int kRecordings = 1000;
  constexpr Eigen::Index kSamples = 2000;
  RandomStream random(11, "blocks");
  int held_slope = 0, held_level = 0;
  for (int r = 0; r < kRecordings; ++r) {
    Eigen::MatrixXd x(kSamples, 2);
    x.col(0) = remembered_noise(random, kSamples, 0.9);
    x.col(1).setOnes();
    const Eigen::VectorXd y =
        x * Eigen::Vector2d(2.0, -1.0) + remembered_noise(random, kSamples, 0.9);
    const BlockFit fit = fit_blocks(x, y, {"slope", "level"});
    held_slope += fit.intervals[0].holds(2.0) ? 1 : 0;
    held_level += fit.intervals[1].holds(-1.0) ? 1 : 0;
  }
  RecordProperty("slope", held_slope);
  RecordProperty("level", held_level);
  EXPECT_GE(held_slope, 930);
  EXPECT_LE(held_slope, 970);
  EXPECT_GE(held_level, 930);
  EXPECT_LE(held_level, 970);
}

TEST(BlockRegressionTest, WhatIsNotFixedIsSaid) {
  Eigen::MatrixXd x(60, 3);
  for (Eigen::Index i = 0; i < 60; ++i) {
    const double s = std::sin(static_cast<double>(i));
    x.row(i) << s, 2.0 * s, 1.0;
  }
  const BlockFit twice = fit_blocks(x, x.col(0), {"stiffness", "damping", "level"});
  EXPECT_THAT(twice.confounded,
              ElementsAre("The data fix only a combination of stiffness, damping."));
  EXPECT_TRUE(std::isinf(twice.intervals[0].high));
  EXPECT_TRUE(std::isfinite(twice.intervals[2].high));
  x.col(1).setZero();
  EXPECT_THAT(fit_blocks(x, x.col(0), {"a", "b", "c"}).confounded,
              ElementsAre("The data say nothing about b."));
}

TEST(BlockRegressionTest, NearlyTheSameIsSaidToo) {
  RandomStream random(2, "alike");
  Eigen::MatrixXd x(400, 2);
  Eigen::VectorXd y(400);
  for (Eigen::Index i = 0; i < 400; ++i) {
    const double a = random.normal();
    x.row(i) << a, a + 0.05 * random.normal();
    y[i] = a + random.normal();
  }
  const BlockFit fit = fit_blocks(x, y, {"a", "b"});
  ASSERT_EQ(fit.confounded.size(), 1u);
  EXPECT_THAT(fit.confounded[0], HasSubstr("a and b can hardly be told apart"));
}

TEST(BlockRegressionTest, BadArgumentsAreRefused) {
  const Eigen::MatrixXd x = Eigen::MatrixXd::Ones(10, 1);
  const Eigen::VectorXd y = Eigen::VectorXd::Ones(10);
  EXPECT_THROW(fit_blocks(x, y, {"a"}, {20, 0.95}), std::invalid_argument);
  EXPECT_THROW(fit_blocks(x, y, {"a"}, {5, 1.0}), std::invalid_argument);
  EXPECT_THROW(fit_blocks(x, y, {"a", "b"}, {5, 0.9}), std::invalid_argument);
}

}  // namespace
}  // namespace haptrial::evaluation
