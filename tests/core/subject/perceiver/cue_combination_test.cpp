#include "core/subject/perceiver/sight.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/base/random.h"

namespace haptrial::subject {
namespace {

TEST(CueCombinationTest, WeightsAndVarianceFollowErnstAndBanks) {
  const Cue seen{0.060, 0.002};
  const Cue felt{0.050, 0.004};
  EXPECT_NEAR(weight_of(seen, felt), 0.8, 1e-12);
  const Cue both = combine(seen, felt);
  EXPECT_NEAR(both.estimate, 0.058, 1e-12);
  EXPECT_NEAR(both.spread * both.spread, 4e-6 * 16e-6 / 20e-6, 1e-16);
  EXPECT_NEAR(combine(felt, seen).estimate, both.estimate, 1e-15) << "whatever their order";
  EXPECT_NEAR(combine(felt, seen).spread, both.spread, 1e-15);
}

TEST(CueCombinationTest, NoOtherWeightHasLessVariance) {
  RandomStream random(1, "cues");
  constexpr int kTrials = 100000;
  const double a = 0.7;
  const double b = 1.3;
  double best = 0.0;
  double others[2] = {0.0, 0.0};
  const double w = weight_of({0.0, a}, {0.0, b});
  for (int i = 0; i < kTrials; ++i) {
    const double x = a * random.normal();
    const double y = b * random.normal();
    best += std::pow(combine({x, a}, {y, b}).estimate, 2) / kTrials;
    others[0] += std::pow((w + 0.15) * x + (0.85 - w) * y, 2) / kTrials;
    others[1] += std::pow((w - 0.15) * x + (1.15 - w) * y, 2) / kTrials;
  }
  const double predicted = std::pow(combine({0.0, a}, {0.0, b}).spread, 2);
  EXPECT_NEAR(best, predicted, 4.0 * predicted * std::sqrt(2.0 / kTrials));
  EXPECT_GT(others[0], best);
  EXPECT_GT(others[1], best);
}

TEST(CueCombinationTest, ACueWithoutNoiseDecidesAndOneOfNoUseDoesNot) {
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(combine({1.0, 0.0}, {5.0, 2.0}).estimate, 1.0);
  EXPECT_EQ(combine({1.0, 0.0}, {5.0, 2.0}).spread, 0.0);
  EXPECT_EQ(combine({1.0, 3.0}, {5.0, infinity}).estimate, 1.0);
  EXPECT_EQ(combine({1.0, 3.0}, {5.0, infinity}).spread, 3.0);
  EXPECT_EQ(combine({1.0, infinity}, {5.0, 3.0}).estimate, 5.0);
  EXPECT_EQ(combine({1.0, infinity}, {5.0, 3.0}).spread, 3.0);
  EXPECT_EQ(combine({1.0, 0.0}, {3.0, 0.0}).estimate, 2.0);
  EXPECT_EQ(combine({1.0, 0.0}, {3.0, 0.0}).spread, 0.0);
}

}  // namespace
}  // namespace haptrial::subject
