#include "analysis/reaching/zero_phase_filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <vector>

namespace haptrial::analysis {
namespace {

using std::numbers::pi;

constexpr double kRate = 1000.0;

/// The transfer function as the page states it.
double gain_of(double f, const ZeroPhaseFilter& filter) {
  const double ratio = std::tan(pi * f / kRate) / std::tan(pi * filter.cutoff / kRate);
  return 1.0 / (1.0 + (std::sqrt(2.0) - 1.0) * std::pow(ratio, filter.order));
}

/// The response to one sample of 1 amid zeros, at a frequency.
std::complex<double> response(double f, const ZeroPhaseFilter& filter) {
  constexpr std::size_t kMiddle = 2000;
  std::vector<double> impulse(2 * kMiddle + 1, 0.0);
  impulse[kMiddle] = 1.0;
  const auto out = filtered(impulse, kRate, filter);
  std::complex<double> sum = 0.0;
  for (std::size_t i = 0; i < impulse.size(); ++i) {
    const double angle = -2.0 * pi * f / kRate * (static_cast<double>(i) - double{kMiddle});
    sum += (*out)[i] * std::polar(1.0, angle);
  }
  return sum;
}

TEST(ZeroPhaseFilterTest, ItsGainIsTheTransferFunctionAndItsPhaseZero) {
  for (const int order : {2, 4, 6, 8, 10}) {
    for (const double cutoff : {8.0, 20.0, 120.0}) {
      const ZeroPhaseFilter filter{order, cutoff};
      for (const double f : {0.0, 2.0, 10.0, 20.0, 35.0, 150.0, 400.0}) {
        const auto h = response(f, filter);
        EXPECT_NEAR(h.real(), gain_of(f, filter), 1e-9) << order << ", " << cutoff << ", " << f;
        EXPECT_NEAR(h.imag(), 0.0, 1e-9) << order << ", " << cutoff << ", " << f;
      }
    }
  }
}

TEST(ZeroPhaseFilterTest, TheCutoffPassesTheRootOfAHalf) {
  for (const int order : {2, 4, 6}) {
    EXPECT_NEAR(response(20.0, {order, 20.0}).real(), std::sqrt(0.5), 1e-9);
  }
}

TEST(ZeroPhaseFilterTest, AStraightLineStaysToItsEnds) {
  std::vector<double> line;
  for (int i = 0; i < 800; ++i) {
    line.push_back(0.3 - 2e-4 * i);
  }
  const auto out = filtered(line, kRate, {});
  for (std::size_t i = 0; i < line.size(); ++i) {
    EXPECT_NEAR((*out)[i], line[i], 1e-6) << i;  // of a way of 0.16
  }
}

TEST(ZeroPhaseFilterTest, ReversedSamplesGiveReversedOnes) {
  std::vector<double> samples;
  for (int i = 0; i < 1000; ++i) {
    samples.push_back(std::exp(-std::pow((i - 400.0) / 40.0, 2)) + 0.2 * std::sin(0.9 * i));
  }
  const std::vector<double> reversed(samples.rbegin(), samples.rend());
  const auto one = filtered(samples, kRate, {}), two = filtered(reversed, kRate, {});
  for (std::size_t i = 200; i < 800; ++i) {
    EXPECT_NEAR((*one)[i], (*two)[999 - i], 1e-9);
  }
}

TEST(ZeroPhaseFilterTest, SlopesOfAParabolaAreExact) {
  std::vector<double> parabola;
  for (int i = 0; i < 6; ++i) {
    parabola.push_back(1.0 + 2.0 * i + 3.0 * i * i);
  }
  const auto slopes = differentiated(parabola, 10.0);
  for (int i = 0; i < 6; ++i) {
    EXPECT_NEAR(slopes[static_cast<std::size_t>(i)], 10.0 * (2.0 + 6.0 * i), 1e-11);
  }
}

TEST(ZeroPhaseFilterTest, ASlowSineKeepsPositionAndVelocity) {
  std::vector<Eigen::Vector3d> position;
  const double w = 2.0 * pi * 1.0;
  for (int i = 0; i < 3000; ++i) {
    position.emplace_back(0.05 * std::sin(w * i / kRate), 0.0, 0.1);
  }
  const auto motion = smooth_motion(position, kRate);
  ASSERT_TRUE(motion);
  for (std::size_t i = 500; i < 2500; i += 100) {
    const double t = static_cast<double>(i) / kRate;
    EXPECT_NEAR(motion->position[i].x(), 0.05 * std::sin(w * t), 1e-6);
    EXPECT_NEAR(motion->velocity[i].x(), 0.05 * w * std::cos(w * t), 1e-5);
    EXPECT_NEAR(motion->velocity[i].z(), 0.0, 1e-12);
  }
}

TEST(ZeroPhaseFilterTest, WhatItCannotFilterIsSaid) {
  const std::vector<double> few{1.0, 2.0, 3.0};
  EXPECT_FALSE(filtered(few, kRate, {}));
  const std::vector<double> gap{1.0, 2.0, std::numeric_limits<double>::quiet_NaN(), 4.0, 5.0};
  EXPECT_FALSE(filtered(gap, kRate, {}));
  const std::vector<double> fine(100, 1.0);
  EXPECT_TRUE(filtered(fine, kRate, {}));
  EXPECT_THROW(filtered(fine, kRate, {3, 20.0}), std::invalid_argument);
  EXPECT_THROW(filtered(fine, kRate, {4, 500.0}), std::invalid_argument);
  EXPECT_THROW(filtered(fine, 0.0, {}), std::invalid_argument);
  EXPECT_THROW(differentiated(std::vector{1.0, 2.0}, kRate), std::invalid_argument);
}

}  // namespace
}  // namespace haptrial::analysis
