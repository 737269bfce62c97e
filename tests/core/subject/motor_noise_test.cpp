#include "core/subject/motor_noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "tests/support/allocation_guard.h"

namespace haptrial::subject::motor_noise_test {
namespace {

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
}  // namespace haptrial::subject::motor_noise_test
