#include "core/sound/harmonics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "tests/core/sound/lines.h"
#include "tests/support/allocation_guard.h"

namespace haptrial::sound::harmonics_test {
namespace {

constexpr double kTau = 2.0 * std::numbers::pi;

/// Amplitude of a sine of a known frequency, by projection: independent of the FFT.
double projected(const std::vector<float>& samples, double rate, double frequency) {
  std::complex<double> sum;
  double weight = 0.0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double t = static_cast<double>(i);
    const double window = 0.5 - 0.5 * std::cos(kTau * t / static_cast<double>(samples.size()));
    sum += window * static_cast<double>(samples[i]) * std::polar(1.0, -kTau * frequency * t / rate);
    weight += window;
  }
  return 2.0 * std::abs(sum) / weight;
}

TEST(SineOfTurnTest, IsTheSine) {
  RandomStream random(1, "phases");
  for (int i = 0; i < 100'000; ++i) {
    const std::uint64_t x = random.bits();
    EXPECT_NEAR(sine_of_turn(x), std::sin(kTau * static_cast<double>(x) * 0x1p-64), 2e-11);
  }
  EXPECT_EQ(sine_of_turn(0), 0.0);
}

TEST(HarmonicsTest, GivesTheLinesThatWereAskedFor) {
  Harmonics harmonics(48'000.0, RandomStream(2, "lines"), 0.0);
  harmonics.aim(lines({{440.0, 0.2, 0.0}, {1234.5, 0.05, 0.0}, {9000.0, 0.01, 0.0}}), 1.0, 1.0);
  const auto samples = drawn(harmonics, 48'000.0, 2.0);
  EXPECT_NEAR(projected(samples, 48'000.0, 440.0), 0.2, 2e-5);
  EXPECT_NEAR(projected(samples, 48'000.0, 1234.5), 0.05, 2e-5);
  EXPECT_NEAR(projected(samples, 48'000.0, 9000.0), 0.01, 2e-5);
  EXPECT_LT(projected(samples, 48'000.0, 5000.0), 1e-5);
}

TEST(HarmonicsTest, ABandwidthIsALorentzianOne) {
  // The mean of x(t) x(t + tau) is a²/2 cos(2 pi f tau) exp(-pi b tau).
  const double rate = 8000.0;
  const double bandwidth = 40.0;
  Harmonics harmonics(rate, RandomStream(3, "width"), 0.0);
  harmonics.aim(lines({{1000.0, 1.0, bandwidth}}), 1.0, 1.0);
  const auto x = drawn(harmonics, rate, 200.0);
  for (const std::size_t lag : {8U, 40U, 80U, 160U}) {  // whole periods
    double sum = 0.0;
    for (std::size_t i = 0; i + lag < x.size(); ++i) {
      sum += static_cast<double>(x[i]) * static_cast<double>(x[i + lag]);
    }
    const double mean = sum / static_cast<double>(x.size() - lag);
    const double tau = static_cast<double>(lag) / rate;
    EXPECT_NEAR(mean, 0.5 * std::exp(-std::numbers::pi * bandwidth * tau), 0.012) << lag;
  }
}

TEST(HarmonicsTest, FrequenciesGlideWithoutABreak) {
  const double rate = 48'000.0;
  Harmonics harmonics(rate, RandomStream(4, "glide"), 0.01);
  const Spectrum one = lines({{500.0, 1.0, 0.0}});
  harmonics.aim(one, 1.0, 1.0);
  drawn(harmonics, rate, 0.2);
  double last = harmonics.next();
  double largest = 0.0;
  for (int i = 0; i < 20'000; ++i) {
    if (i % 1000 == 0) {
      harmonics.aim(one, i % 2000 == 0 ? 3.0 : 1.0, 1.0);
    }
    const double now = harmonics.next();
    largest = std::max(largest, std::abs(now - last));
    last = now;
  }
  EXPECT_LT(largest, kTau * 1500.0 / rate * 1.001);  // no faster than the fastest sine
}

TEST(HarmonicsTest, WhatTheRateCannotCarryIsLeftOut) {
  const double rate = 1000.0;
  Harmonics harmonics(rate, RandomStream(5, "rate"), 0.0);
  harmonics.aim(lines({{120.0, 0.3, 0.0}, {500.0, 5.0, 0.0}, {1100.0, 5.0, 0.0}}), 1.0, 1.0);
  auto samples = drawn(harmonics, rate, 4.0);
  EXPECT_NEAR(projected(samples, rate, 120.0), 0.3, 1e-4);
  for (const float sample : samples) {
    ASSERT_LE(std::abs(sample), 0.3001F);  // and nothing else: 1100 Hz would appear at 100 Hz
  }
  harmonics.aim(lines({{120.0, 0.3, 0.0}, {400.0, 5.0, 0.0}}), 1.3, 1.0);  // 520 Hz
  samples = drawn(harmonics, rate, 4.0);
  EXPECT_NEAR(projected(samples, rate, 156.0), 0.3, 1e-4);
  EXPECT_LT(projected(samples, rate, 480.0), 1e-4);
}

TEST(HarmonicsTest, TheSameSeedGivesTheSameSamplesAndNothingIsAllocated) {
  const Spectrum spectrum = lines({{300.0, 0.2, 20.0}, {900.0, 0.1, 50.0}}, 0.05);
  Harmonics a(48'000.0, RandomStream(6, "seed"));
  Harmonics b(48'000.0, RandomStream(6, "seed"));
  const test::AllocationGuard guard;
  double square = 0.0;
  for (int i = 0; i < 100'000; ++i) {
    if (i % 480 == 0) {
      a.aim(spectrum, 1.0 + 0.001 * (i % 7), 1.0);
      b.aim(spectrum, 1.0 + 0.001 * (i % 7), 1.0);
    }
    const double x = a.next();
    ASSERT_EQ(x, b.next());
    square += x * x;
  }
  EXPECT_EQ(guard.count(), 0U);
  EXPECT_NEAR(square / 1e5, 0.5 * 0.04 + 0.5 * 0.01 + 0.0025, 6e-4);
}

}  // namespace
}  // namespace haptrial::sound::harmonics_test
