#include "analysis/contact/evaluation/rendering_error.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "core/base/random.h"

namespace haptrial::evaluation {
namespace {

using Vectors = std::vector<Eigen::Vector3d>;
using testing::HasSubstr;
using testing::Not;

Vectors random_forces(std::size_t n, const char* name) {
  RandomStream random(4, name);
  Vectors forces;
  for (std::size_t i = 0; i < n; ++i) {
    forces.emplace_back(random.normal(), random.normal(), 2.0 + random.normal());
  }
  return forces;
}

TEST(RenderingErrorTest, TheTwoNamesOfTheSourceDiffer) {
  const Vectors measured(4, Eigen::Vector3d::Zero());
  const Vectors rendered{{3.0, 4.0, 0.0}, {0.0, 0.0, 0.0}, {0.0, 0.0, -1.0}, {0.0, 0.0, 0.0}};
  const ForceError error = force_error(measured, rendered);
  EXPECT_NEAR(error.mean_norm, 6.0 / 4.0, 1e-15);
  EXPECT_NEAR(error.root_mean_square, std::sqrt(26.0 / 4.0), 1e-15);
  EXPECT_EQ(error.worst, 5.0);
}

TEST(RenderingErrorTest, BandsAddUpToTheWhole) {
  for (const std::size_t n : {1u, 2u, 3u, 1000u, 1009u, 4097u}) {
    const Vectors a = random_forces(n, "a"), b = random_forces(n, "b");
    const BandError band = band_error(a, b, 1000.0);
    const double whole = force_error(a, b).root_mean_square;
    // GSL's transform of prime lengths (1009) loses about n roundings.
    const double rounding = 1e-14 * static_cast<double>(n) + 1e-12;
    EXPECT_NEAR(std::hypot(band.slow, band.middle, band.fast), whole, rounding * whole) << n;
    EXPECT_NEAR(band.total, whole, rounding * whole) << n;
  }
}

TEST(RenderingErrorTest, EachToneFallsIntoItsBand) {
  const std::size_t n = 2000;
  Vectors error(n, Eigen::Vector3d::Zero()), none = error;
  for (std::size_t i = 0; i < n; ++i) {
    const double t = static_cast<double>(i) / 1000.0;
    const auto tone = [t](double hz) { return std::sin(2.0 * std::numbers::pi * hz * t); };
    error[i] = {2.0 * tone(9.5) + 1.0, 3.0 * tone(10.0), 5.0 * tone(100.0)};
  }
  const BandError band = band_error(error, none, 1000.0);
  EXPECT_NEAR(band.slow, std::sqrt(2.0 + 1.0), 1e-10);
  EXPECT_NEAR(band.middle, 3.0 / std::sqrt(2.0), 1e-10);
  EXPECT_NEAR(band.fast, 5.0 / std::sqrt(2.0), 1e-10);
}

TEST(RenderingErrorTest, PlacesBeyondTheThresholdAreFound) {
  Vectors a(10, Eigen::Vector3d::Zero()), b = a;
  b[2].x() = 0.002;
  b[3].x() = 0.005;
  b[7].y() = -0.0011;
  b[8].y() = 0.001;
  const PositionError error = position_error(a, b, 0.001);
  ASSERT_EQ(error.places.size(), 2u);
  EXPECT_EQ(error.places[0].first, 2u);
  EXPECT_EQ(error.places[0].last, 3u);
  EXPECT_EQ(error.places[0].worst, 0.005);
  EXPECT_EQ(error.places[1].first, 7u);
  EXPECT_EQ(error.places[1].last, 7u);
  EXPECT_NEAR(error.beyond_share, 0.3, 1e-15);
}

TEST(RenderingErrorTest, TheVerdictCountsInThresholds) {
  const Vectors measured = random_forces(1000, "measured");
  Vectors rendered = measured;
  for (auto& f : rendered) {
    f *= 1.069;
  }
  NoticeableError error = noticeable_error(measured, rendered);
  EXPECT_NEAR(error.median, 0.069 / 0.07, 1e-9);
  EXPECT_EQ(error.beyond_low, 0.0);
  EXPECT_THAT(error.verdict, HasSubstr("rarely"));
  for (std::size_t i = 0; i < measured.size(); ++i) {
    rendered[i] = measured[i] * (i % 4 == 0 ? 1.2 : i % 4 == 1 ? 1.08 : 1.0);
  }
  error = noticeable_error(measured, rendered, 0.0);
  EXPECT_NEAR(error.beyond_low, 0.5, 1e-12);
  EXPECT_NEAR(error.beyond_high, 0.25, 1e-12);
  EXPECT_THAT(error.verdict, HasSubstr("now and then"));
  EXPECT_THAT(noticeable_error(measured, rendered, 1e9).verdict, HasSubstr("No sample"));
}

// Pang, Tan and Durlach 1991: 7 % was found from 2.5 to 10 N.
TEST(RenderingErrorTest, TheVerdictSaysWhereItsThresholdsWereMeasured) {
  const Vectors forces{{1.0, 0, 0}, {0, 2.6, 0}, {0, 0, 9.9}, {10.1, 0, 0}};
  const NoticeableError all = noticeable_error(forces, forces);
  EXPECT_EQ(all.outside, 0.5);
  EXPECT_THAT(all.verdict, HasSubstr("from 2.5 to 10 N; 50 % of the samples lie outside."));
  const Vectors inside{forces[1], forces[2]};
  EXPECT_THAT(noticeable_error(inside, inside).verdict, Not(HasSubstr("outside")));
}

TEST(RenderingErrorTest, TicksAreRanked) {
  std::vector<double> times;
  for (int i = 10000; i >= 1; --i) {
    times.push_back(i);
  }
  const TickTimes ticks = tick_times(times);
  EXPECT_EQ(ticks.median, 5000.0);
  EXPECT_EQ(ticks.p999, 9990.0);
  EXPECT_EQ(ticks.worst, 10000.0);
  EXPECT_EQ(tick_times(std::vector{3.0}).p999, 3.0);
  EXPECT_THROW(tick_times({}), std::invalid_argument);
}

TEST(RenderingErrorTest, BadArgumentsAreRefused) {
  const Vectors two(2, Eigen::Vector3d::Zero()), three(3, Eigen::Vector3d::Zero());
  EXPECT_THROW(force_error(two, three), std::invalid_argument);
  EXPECT_THROW(force_error({}, {}), std::invalid_argument);
  EXPECT_THROW(band_error(two, two, 0.0), std::invalid_argument);
}

}  // namespace
}  // namespace haptrial::evaluation
