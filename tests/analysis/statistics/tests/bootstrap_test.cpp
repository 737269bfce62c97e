#include "analysis/statistics/tests/bootstrap.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "analysis/statistics/base/descriptive.h"
#include "core/base/random.h"

namespace haptrial::analysis::bootstrap_test {
namespace {

using testing::HasSubstr;
using Values = std::vector<double>;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

double mean(std::span<const double> values) { return moments(values)->mean(); }

double median(std::span<const double> values) { return *quantile(values, 0.5); }

Values skewed(RandomStream& random, std::size_t count) {
  Values values(count);
  for (auto& value : values) {
    value = -std::log1p(-random.uniform());  // exponential, mean 1
  }
  return values;
}

Resampling draws(std::size_t count, int threads = 1) { return {7, "test", count, threads}; }

TEST(Bootstrap, GivesTheSameBytesForAnyNumberOfThreads) {
  RandomStream random(1, "values");
  const Values values = skewed(random, 24);
  const auto one = bootstrap(values, median, draws(3000, 1));
  ASSERT_TRUE(one);
  for (const int threads : {2, 3, 8}) {
    const auto many = bootstrap(values, median, draws(3000, threads));
    EXPECT_EQ(many->low, one->low);
    EXPECT_EQ(many->high, one->high);
    EXPECT_EQ(many->bias, one->bias);
  }
  const auto other = bootstrap(values, mean, {8, "test", 3000, 1});
  EXPECT_NE(other->low, bootstrap(values, mean, draws(3000))->low) << "the seed has no effect";
  const auto named = bootstrap(values, mean, {7, "other", 3000, 1});
  EXPECT_NE(named->low, bootstrap(values, mean, draws(3000))->low) << "the name has no effect";
}

TEST(Bootstrap, DrawsEveryRowEquallyOften) {
  constexpr std::size_t kRows = 10, kDraws = 20000;
  std::vector<std::size_t> counts(kRows, 0);
  const auto count = [&](const DrawnRows& rows) {
    for (const auto row : rows.front()) {
      ++counts[row];
    }
    return static_cast<double>(rows.front().front());
  };
  (void)bootstrap({kRows}, count, draws(kDraws));
  // Binomial: 20000 each, five standard deviations; 9 or 10 more from the jackknife.
  for (const auto n : counts) {
    EXPECT_NEAR(static_cast<double>(n), 20000.0, 5.0 * std::sqrt(18000.0) + 10.0);
  }
}

TEST(Bootstrap, CoversTheMeanOfSkewedValues) {
  RandomStream random(2006, "coverage of BCa");
  constexpr int kStudies = 400;
  int covered = 0, above = 0, skewed_up = 0;
  for (int i = 0; i < kStudies; ++i) {
    const Values values = skewed(random, 30);
    const auto interval =
        bootstrap(values, mean, {static_cast<std::uint64_t>(i), "coverage", 999, 1});
    ASSERT_TRUE(interval);
    covered += interval->low < 1.0 && 1.0 < interval->high ? 1 : 0;
    above += interval->high < 1.0 ? 1 : 0;
    skewed_up += interval->acceleration > 0.0 ? 1 : 0;
  }
  // Nominal 0.95; 30 exponential values are known to reach about 0.93.
  EXPECT_NEAR(covered / static_cast<double>(kStudies), 0.935, 0.04);
  EXPECT_LT(above / static_cast<double>(kStudies), 0.08);
  EXPECT_GT(skewed_up, kStudies * 9 / 10);
}

TEST(Bootstrap, MovesWithTheValues) {
  RandomStream random(3, "values");
  Values values = skewed(random, 20);
  for (auto& v : values) {
    v = std::round(v * 256.0) / 256.0;
  }
  const auto plain = bootstrap(values, mean, draws(999));
  for (auto& v : values) {
    v = 4.0 * v + 1024.0;
  }
  const auto moved = bootstrap(values, mean, draws(999));
  EXPECT_NEAR(moved->low, 4.0 * plain->low + 1024.0, 1e-11);
  EXPECT_NEAR(moved->high, 4.0 * plain->high + 1024.0, 1e-11);
  EXPECT_NEAR(moved->acceleration, plain->acceleration, 1e-11);
}

TEST(Bootstrap, OfADifferenceIsThatOfWellSeparatedSamples) {
  const auto interval =
      bootstrap_difference(Values{11, 12, 13, 15, 14}, Values{1, 2, 3, 2.5, 4, 3.5}, draws(1999));
  ASSERT_TRUE(interval);
  EXPECT_NEAR(interval->estimate, 13.0 - 16.0 / 6.0, 1e-14);
  // Standard error of the difference with variances by n: sqrt(2 / 5 + 1.0139 / 6).
  EXPECT_NEAR(interval->high - interval->low, 2.0 * 1.96 * std::sqrt(0.4 + 0.1667), 0.3);
}

TEST(Bca, IsThePercentileIntervalWithoutBiasAndAcceleration) {
  Values replicates(999);
  std::iota(replicates.begin(), replicates.end(), 1.0);
  const auto interval = bca_interval(500.0, replicates, {{1, 2, 3}}, 0.9);
  ASSERT_TRUE(interval);
  EXPECT_NEAR(interval->bias, 0.0, 1e-15);
  EXPECT_NEAR(interval->acceleration, 0.0, 1e-15);
  EXPECT_NEAR(interval->low, 50.0, 1e-9);
  EXPECT_NEAR(interval->high, 950.0, 1e-9);
}

TEST(Bca, TakesForATieWhatOnlyRoundingParts) {
  Values replicates(998);
  std::iota(replicates.begin(), replicates.end(), 1.0);
  const double tie = 0.1 + 0.2 + 499.2;  // 499.5 but for the last digits
  for (int i = 0; i < 400; ++i) {
    replicates.push_back(499.5);
  }
  EXPECT_NEAR(bca_interval(tie, replicates, {{1, 2, 3}}, 0.9)->bias, 0.0, 1e-15);
}

TEST(Bca, SaysWhyItIsNotDefined) {
  const Values one{1};
  EXPECT_THAT(bootstrap(Values{}, mean, draws(99)).because(), HasSubstr("no values"));
  EXPECT_THAT(bootstrap(one, mean, draws(99)).because(), HasSubstr("at least two"));
  EXPECT_THAT(bootstrap(Values{1, kNan}, mean, draws(99)).because(), HasSubstr("finite"));
  EXPECT_THAT(bootstrap(Values{2, 2, 2}, mean, draws(99)).because(), HasSubstr("same value"));
  EXPECT_THAT(bootstrap(Values{1, 2, 4}, mean, draws(19)).because(),
              HasSubstr("beyond the 19 resamples; about"));
  EXPECT_THAT(bootstrap(Values{1, 2}, mean, draws(0)).because(), HasSubstr("no resamples"));
  const auto deviation = [](std::span<const double> v) {
    return 1.0 / std::sqrt(moments(v)->squares);
  };
  EXPECT_THAT(bootstrap(Values{1, 2, 3}, deviation, draws(999)).because(),
              HasSubstr("some resamples"));
  EXPECT_THAT(bca_interval(9.0, {1, 2, 3}, {{1, 2}}).because(), HasSubstr("same side"));
  EXPECT_THAT(bca_interval(kNan, {1, 2, 3}, {{1, 2}}).because(), HasSubstr("does not exist"));
  EXPECT_THAT(bootstrap_difference(Values{1, 2}, Values{kNan, 2}, draws(99)).because(),
              HasSubstr("finite"));
  const auto failing = [](std::span<const double>) -> double { throw std::runtime_error("mine"); };
  EXPECT_THROW(bootstrap(Values{1, 2}, failing, draws(999, 2)), std::runtime_error);
}

}  // namespace
}  // namespace haptrial::analysis::bootstrap_test
