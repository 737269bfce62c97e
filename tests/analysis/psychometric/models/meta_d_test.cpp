// meta-d' beside an optimisation in R (reference/decisions.R) and observers whose meta-d' is known.
#include "analysis/psychometric/models/meta_d.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/base/random.h"

namespace haptrial::analysis::meta_d_test {
namespace {

using testing::HasSubstr;

void expect_meta(const RatingCounts& counts, std::size_t noise_ratings, double meta, double ratio,
                 double log_likelihood, double error) {
  const auto found = meta_d_prime(counts, noise_ratings);
  ASSERT_TRUE(found) << found.because();
  EXPECT_NEAR(found->meta_d, meta, 1e-5);
  EXPECT_NEAR(found->ratio, ratio, 1e-5);
  EXPECT_NEAR(found->log_likelihood, log_likelihood, 1e-6);
  EXPECT_NEAR((found->high - found->low) / (2.0 * 1.959964), error, 0.05 * error);
}

// R's error is of the observed curvature, ours of the expected one.
TEST(MetaDTest, AgreesWithAnOptimisationInR) {
  expect_meta({{36, 24, 17, 20, 10, 12, 9, 2}, {1, 4, 10, 11, 19, 18, 28, 39}}, 4, 1.46073617,
              0.98032682, -343.2137973, 0.25316978);
  expect_meta({{60, 30, 10, 15, 5, 0}, {3, 7, 12, 20, 38, 40}}, 3, 2.43213192, 1.31511207,
              -226.9037957, 0.30879893);
}

struct Observer {
  double d_prime, criterion, meta_d;
  int trials;
};

/// Answers by d' and criterion, ratings by meta-d' given stimulus and answer.
RatingCounts answers_of(const Observer& o, RandomStream& random) {
  RatingCounts counts{std::vector<int>(8, 0), std::vector<int>(8, 0)};
  const double own = o.meta_d * o.criterion / o.d_prime;
  for (int trial = 0; trial < o.trials; ++trial) {
    const double side = trial % 2 == 1 ? 0.5 : -0.5;
    const bool yes = random.normal() + side * o.d_prime > o.criterion;
    double evidence = 0.0;
    do {
      evidence = random.normal() + side * o.meta_d - own;
    } while ((evidence > 0.0) != yes);
    const double far = std::abs(evidence);
    const std::size_t sure = far < 0.4 ? 0 : far < 0.8 ? 1 : far < 1.3 ? 2 : 3;
    ++(trial % 2 == 1 ? counts.signal : counts.noise)[yes ? 4 + sure : 3 - sure];
  }
  return counts;
}

TEST(MetaDTest, IntervalsOfAThousandObserversHoldTheTruth) {
  for (const Observer& truth :
       {Observer{1.5, 0.0, 1.5, 400}, Observer{1.5, 0.2, 1.0, 400}, Observer{1.0, 0.3, 0.5, 400}}) {
    int held = 0, ratio_held = 0;
    double sum = 0.0;
    for (int i = 0; i < 1000; ++i) {
      RandomStream random(3, "ratings " + std::to_string(i));
      const auto found = meta_d_prime(answers_of(truth, random), 4);
      ASSERT_TRUE(found) << found.because();
      const double ratio = truth.meta_d / truth.d_prime;
      held += found->low <= truth.meta_d && truth.meta_d <= found->high ? 1 : 0;
      ratio_held += found->ratio_low <= ratio && ratio <= found->ratio_high ? 1 : 0;
      sum += found->meta_d - truth.meta_d;
    }
    EXPECT_GE(held, 930);
    EXPECT_LE(held, 970);
    EXPECT_GE(ratio_held, 930);
    EXPECT_LE(ratio_held, 970);
    EXPECT_NEAR(sum / 1000.0, 0.0, 0.04);
  }
}

TEST(MetaDTest, RatingsThatNobodyGaveChangeNothing) {
  const auto with = meta_d_prime({{40, 0, 20, 15, 0, 5}, {5, 0, 15, 20, 0, 40}}, 3);
  const auto without = meta_d_prime({{40, 20, 15, 5}, {5, 15, 20, 40}}, 2);
  ASSERT_TRUE(with && without);
  EXPECT_NEAR(with->meta_d, without->meta_d, 1e-9);
}

TEST(MetaDTest, RatingsThatDoNotTellAreNotDefined) {
  EXPECT_THAT(meta_d_prime({{50, 20}, {20, 50}}, 1).because(), HasSubstr("one rating only"));
  EXPECT_THAT(meta_d_prime({{20, 20, 20, 20}, {19, 21, 20, 20}}, 2).because(),
              HasSubstr("not clearly above 0"));
  // Nearly every answer was called certain.
  EXPECT_THAT(meta_d_prime({{79, 0, 1, 2}, {72, 2, 2, 124}}, 2).because(),
              HasSubstr("standard error"));
  EXPECT_FALSE(meta_d_prime({{0, 0}, {3, 4}}, 1));
  EXPECT_THROW(meta_d_prime({{1, 2}, {3, 4}}, 3), std::invalid_argument);
}

}  // namespace
}  // namespace haptrial::analysis::meta_d_test
