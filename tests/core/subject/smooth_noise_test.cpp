#include "core/subject/smooth_noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace haptrial::subject {
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

}  // namespace
}  // namespace haptrial::subject
