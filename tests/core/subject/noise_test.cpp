#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "core/subject/noise.h"
#include "tests/support/allocation_guard.h"

namespace haptrial::subject::noise_test {
namespace {

TEST(SmoothNoiseTest, HasMeanZeroAndVarianceOneFromTheStart) {
  RandomStream random(1, "noise");
  SmoothNoise noise(0.01, 0.3);
  constexpr int kRuns = 20000;
  for (const int steps : {1, 5, 60}) {
    double sum = 0.0;
    double squares = 0.0;
    for (int run = 0; run < kRuns; ++run) {
      noise.restart(random);
      double value = 0.0;
      for (int i = 0; i < steps; ++i) {
        value = noise.next(random);
      }
      sum += value;
      squares += value * value;
    }
    EXPECT_NEAR(sum / kRuns, 0.0, 4.0 / std::sqrt(kRuns)) << steps;
    EXPECT_NEAR(squares / kRuns, 1.0, 4.0 * std::sqrt(2.0 / kRuns)) << steps;
  }
}

TEST(SmoothNoiseTest, CorrelationIsThatOfTwoEqualLags) {
  // rho(t) = (1 + t / tau) exp(-t / tau) in the limit of small steps.
  RandomStream random(2, "noise");
  SmoothNoise noise(0.002, 0.2);
  noise.restart(random);
  constexpr int kCount = 2000000;
  std::vector<double> x(kCount);
  for (double& value : x) {
    value = noise.next(random);
  }
  for (const int lag : {25, 100, 200}) {
    double product = 0.0;
    for (int i = lag; i < kCount; ++i) {
      product += x[i] * x[i - lag];
    }
    const double u = lag * 0.002 / 0.2;
    EXPECT_NEAR(product / (kCount - lag), (1.0 + u) * std::exp(-u), 0.04) << lag;
  }
}

constexpr double kStep = 1e-3;
constexpr int kCount = 400000;

TEST(MotorNoiseTest, SpreadIsAFixedShareOfTheForce) {
  SubjectParameters person;
  person.force_noise = 0.04;
  for (const double force : {1.0, 4.0, 10.0}) {
    MotorNoise noise(person, kStep, RandomStream(1, "motor"));
    double sum = 0.0;
    double squares = 0.0;
    for (int i = 0; i < kCount; ++i) {
      const double error = noise.press(force) - force;
      sum += error / kCount;
      squares += error * error / kCount;
    }
    EXPECT_NEAR(std::sqrt(squares) / force, 0.04, 0.003);
    EXPECT_NEAR(sum / force, 0.0, 0.004);
  }
}

TEST(MotorNoiseTest, NoForceNoNoise) {
  MotorNoise noise(SubjectParameters{}, kStep, RandomStream(1, "motor"));
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(noise.press(0.0), 0.0);
  }
}

TEST(MotorNoiseTest, TremorHasItsSizeAndPeaksAtItsFrequency) {
  SubjectParameters person;
  person.tremor = 0.05;
  person.tremor_frequency = 9.0;
  MotorNoise noise(person, kStep, RandomStream(2, "motor"));
  std::vector<double> x(kCount);
  double squares = 0.0;
  for (double& value : x) {
    value = noise.tremor().z();
    squares += value * value / kCount;
  }
  EXPECT_NEAR(std::sqrt(squares), 0.05, 0.005);
  const auto power = [&](double hertz) {  // averaged over windows of one second
    double total = 0.0;
    for (int start = 0; start + 1000 <= kCount; start += 1000) {
      std::complex<double> sum = 0.0;
      for (int i = 0; i < 1000; ++i) {
        sum += std::polar(x[start + i], -2.0 * std::numbers::pi * hertz * i * kStep);
      }
      total += std::norm(sum);
    }
    return total;
  };
  EXPECT_GT(power(9.0), 3.0 * power(3.0));
  EXPECT_GT(power(9.0), 3.0 * power(16.0));
}

TEST(MotorNoiseTest, DoesNotAllocate) {
  MotorNoise noise(SubjectParameters{}, kStep, RandomStream(1, "motor"));
  const test::AllocationGuard guard;
  double sum = 0.0;
  for (int i = 0; i < 1000; ++i) {
    sum += noise.press(3.0) + noise.tremor().x();
  }
  EXPECT_EQ(guard.count(), 0u);
  EXPECT_GT(sum, 0.0);
}

}  // namespace

}  // namespace haptrial::subject::noise_test
