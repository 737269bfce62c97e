#include "core/stimulus/spatial_trajectory.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "core/base/definition/schema.h"
#include "core/base/error.h"
#include "core/base/random.h"
#include "tests/support/allocation_guard.h"

namespace haptrial::stimulus::spatial_trajectory_test {
namespace {

using Eigen::Vector3d;

SpatialTrajectory drawn(std::uint64_t seed, const TrajectoryParameters& p = {}) {
  RandomStream random(seed, "trajectory");
  return {p, random};
}

/// Smallest and largest value of a coordinate over the stored points.
std::pair<double, double> extent(const SpatialTrajectory& path, int axis) {
  const auto [low, high] =
      std::minmax_element(path.points().begin(), path.points().end(),
                          [&](const auto& a, const auto& b) { return a[axis] < b[axis]; });
  return {(*low)[axis], (*high)[axis]};
}

TEST(SpatialTrajectoryTest, SpansTenByZeroBySixCentimetresAboutTheOrigin) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const SpatialTrajectory path = drawn(seed);
    EXPECT_DOUBLE_EQ(path.points().front().x(), -0.05);
    EXPECT_DOUBLE_EQ(path.points().back().x(), 0.05);
    // The turning points lie between two stored points: below by the sagitta of a chord at most.
    EXPECT_NEAR(extent(path, 2).first, -0.03, 4e-7) << seed;
    EXPECT_NEAR(extent(path, 2).second, 0.03, 4e-7) << seed;
    EXPECT_EQ(extent(path, 1), std::make_pair(0.0, 0.0)) << seed;
    for (std::size_t i = 1; i < path.points().size(); ++i) {
      ASSERT_GT(path.points()[i].x(), path.points()[i - 1].x()) << "from left to right";
    }
  }
}

TEST(SpatialTrajectoryTest, LengthLiesBetweenTheDiagonalAndTheSumOfItsWays) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const SpatialTrajectory path = drawn(seed);
    double up_and_down = 0.0;
    for (std::size_t i = 1; i < path.points().size(); ++i) {
      up_and_down += std::abs(path.points()[i].z() - path.points()[i - 1].z());
    }
    EXPECT_GT(path.length(), std::hypot(0.1, 0.06)) << seed;
    EXPECT_LT(path.length(), 0.1 + up_and_down + 1e-6) << seed;
    EXPECT_DOUBLE_EQ(path.duration(), path.length() / 0.016);
  }
}

TEST(SpatialTrajectoryTest, SpeedAlongTheArcIsConstant) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const SpatialTrajectory path = drawn(seed);
    constexpr double kStep = 1e-3;
    for (double t = kStep; t < path.duration() - 2 * kStep; t += 0.0137) {
      const Vector3d way = path.at(t + kStep).position - path.at(t).position;
      ASSERT_NEAR(way.norm() / kStep, 0.016, 0.016 * 1e-3) << seed << " at " << t;
      ASSERT_NEAR(path.at(t).velocity.norm(), 0.016, 0.016 * 1e-3) << seed << " at " << t;
    }
  }
}

TEST(SpatialTrajectoryTest, VelocityIsTheSlopeOfPosition) {
  const SpatialTrajectory path = drawn(3);
  constexpr double kStep = 1e-3;
  for (double t = 0.1; t < path.duration() - 0.1; t += 0.0137) {
    const Vector3d slope = (path.at(t + kStep).position - path.at(t - kStep).position) / 2 / kStep;
    // The direction turns by at most curvature · way: 1100 /m · 2 · 16 µm.
    ASSERT_LT((path.at(t).velocity - slope).norm(), 0.016 * 0.05) << t;
  }
}

TEST(SpatialTrajectoryTest, RestsAtBothEnds) {
  const SpatialTrajectory path = drawn(4);
  const double end = path.duration();
  for (const double t : {-1.0, 0.0, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_EQ(path.at(t).position, path.points().front()) << t;
    EXPECT_TRUE(path.at(t).velocity.isZero()) << t;
  }
  for (const double t : {end, end + 1.0, 1e300}) {
    EXPECT_EQ(path.at(t).position, path.points().back()) << t;
    EXPECT_TRUE(path.at(t).velocity.isZero()) << t;
  }
  EXPECT_LT((path.at(end * (1.0 - 1e-9)).position - path.points().back()).norm(), 1e-9);
}

TEST(SpatialTrajectoryTest, TurnsNoOftenerThanTheBandLimitAllows) {
  int most = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const auto points = drawn(seed).points();
    int extrema = 0;
    for (std::size_t i = 2; i < points.size(); ++i) {
      extrema += (points[i].z() > points[i - 1].z()) != (points[i - 1].z() > points[i - 2].z());
    }
    // Two a cycle, three cycles over the way, and one at either end.
    EXPECT_LE(extrema, 2 * 3 + 2) << seed;
    most = std::max(most, extrema);
  }
  EXPECT_GE(most, 4) << "the curves do use their band";
}

/// The share of a curve's variance in z above `frequency` [cycles/m], with a Hann window.
double share_above(const SpatialTrajectory& path, double frequency) {
  constexpr int kSamples = 512;
  std::vector<double> z(kSamples);
  std::size_t i = 1;
  for (int k = 0; k < kSamples; ++k) {
    const double x = 0.1 * ((k + 0.5) / kSamples - 0.5);
    while (path.points()[i].x() < x) {
      ++i;
    }
    const Vector3d a = path.points()[i - 1];
    const Vector3d b = path.points()[i];
    z[k] = a.z() + (x - a.x()) / (b.x() - a.x()) * (b.z() - a.z());
  }
  double total = 0.0;
  double above = 0.0;
  for (int line = 0; line < kSamples / 2; ++line) {
    std::complex<double> sum = 0.0;
    for (int k = 0; k < kSamples; ++k) {
      const double angle = 2.0 * std::numbers::pi * (k + 0.5) / kSamples;
      sum += z[k] * (1.0 - std::cos(angle)) * std::polar(1.0, -line * angle);
    }
    total += std::norm(sum);
    above += line / 0.1 > frequency ? std::norm(sum) : 0.0;
  }
  return above / total;
}

TEST(SpatialTrajectoryTest, HasNothingFarAboveTheBandLimit) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    // The window leaks over two lines of 10 cycles/m.
    EXPECT_LT(share_above(drawn(seed), 55.0), 1e-4) << seed;
  }
  TrajectoryParameters fast;
  fast.max_spatial_frequency = 300.0;
  EXPECT_GT(share_above(drawn(1, fast), 55.0), 0.1) << "the measure sees what is above";
}

TEST(SpatialTrajectoryTest, SameSeedSameCurveOtherSeedOtherCurve) {
  EXPECT_EQ(drawn(5).points(), drawn(5).points());
  for (std::uint64_t a = 0; a < 20; ++a) {
    for (std::uint64_t b = 0; b < a; ++b) {
      const auto path_a = drawn(a);
      const auto path_b = drawn(b);
      double apart = 0.0;
      for (double u = 0.0; u < 1.0; u += 0.01) {
        apart = std::max(apart, (path_a.at(u * path_a.duration()).position -
                                 path_b.at(u * path_b.duration()).position)
                                    .norm());
      }
      EXPECT_GT(apart, 0.005) << a << " and " << b;
    }
  }
}

TEST(SpatialTrajectoryTest, APolylineIsFollowedRoundItsCorner) {
  const SpatialTrajectory path({{0, 0, 0}, {0.3, 0, 0}, {0.3, 0, 0}, {0.3, 0.4, 0}}, 0.1);
  EXPECT_DOUBLE_EQ(path.length(), 0.7);
  EXPECT_DOUBLE_EQ(path.duration(), 7.0);
  EXPECT_LT((path.at(1.5).position - Vector3d(0.15, 0, 0)).norm(), 1e-12);
  EXPECT_LT((path.at(1.5).velocity - Vector3d(0.1, 0, 0)).norm(), 1e-12);
  EXPECT_LT((path.at(3.0).position - Vector3d(0.3, 0, 0)).norm(), 5e-5) << "a step of the corner";
  EXPECT_LT((path.at(5.0).position - Vector3d(0.3, 0.2, 0)).norm(), 1e-12);
  EXPECT_LT((path.at(5.0).velocity - Vector3d(0, 0.1, 0)).norm(), 1e-12);
}

TEST(SpatialTrajectoryTest, PointsThatSpanNoCurveAreRefused) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(SpatialTrajectory({}, 0.1), std::invalid_argument);
  EXPECT_THROW(SpatialTrajectory({{1, 2, 3}}, 0.1), std::invalid_argument);
  EXPECT_THROW(SpatialTrajectory({{1, 2, 3}, {1, 2, 3}}, 0.1), std::invalid_argument);
  EXPECT_THROW(SpatialTrajectory({{1, 2, 3}, {1, nan, 3}}, 0.1), std::invalid_argument);
  for (const double speed : {0.0, -0.1, nan}) {
    EXPECT_THROW(SpatialTrajectory({{0, 0, 0}, {1, 0, 0}}, speed), std::invalid_argument);
  }
}

TEST(SpatialTrajectoryTest, AskingDoesNotAllocate) {
  const SpatialTrajectory path = drawn(6);
  const test::AllocationGuard guard;
  Vector3d sum = Vector3d::Zero();
  for (double t = -1.0; t < path.duration() + 1.0; t += 0.01) {
    sum += path.at(t).position;
  }
  EXPECT_EQ(guard.count(), 0u);
  EXPECT_TRUE(sum.allFinite());
}

TEST(SpatialTrajectoryTest, ParametersAreReadWithTheirBounds) {
  Table good = Table::parse(
      "length_x = 0.2\nrange_z = 0.04\nsinusoids = 5\nmax_spatial_frequency = 20.0\nspeed = 0.03\n",
      "f.toml");
  const TrajectoryParameters p = trajectory_schema().read(good);
  EXPECT_NO_THROW(good.finish());
  const SpatialTrajectory path = drawn(1, p);
  EXPECT_NEAR(extent(path, 0).second - extent(path, 0).first, 0.2, 1e-12);
  EXPECT_NEAR(extent(path, 2).second - extent(path, 2).first, 0.04, 1e-6);
  EXPECT_EQ(path.speed(), 0.03);
  EXPECT_EQ(p.sinusoids, 5);
  Table bad = Table::parse(
      "length_x = 0\nrange_z = -1\nsinusoids = 0\nmax_spatial_frequency = inf\nspeed = 2.0\n",
      "f.toml");
  trajectory_schema().read(bad);
  try {
    bad.finish();
    FAIL();
  } catch (const InputError& error) {
    const std::string what = error.what();
    EXPECT_EQ(std::count(what.begin(), what.end(), '\n'), 4) << what;
  }
}

}  // namespace
}  // namespace haptrial::stimulus::spatial_trajectory_test
