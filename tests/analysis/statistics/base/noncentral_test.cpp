#include "analysis/statistics/base/noncentral.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "analysis/statistics/base/distributions.h"

namespace haptrial::analysis {
namespace {

using testing::HasSubstr;

// The definition, P(Z + delta < t S) with S² = chi²(df) / df, as an integral over u = log S by the
// trapezoidal rule, whose error falls faster than any power of the step for such a bell.
double quadrature(double t, double df, double delta, bool upper) {
  const double constant = std::numbers::ln2 + 0.5 * df * std::log(0.5 * df) - std::lgamma(0.5 * df);
  const double width = 1.0 / std::sqrt(2.0 * df);  // of the bell about 0
  const double step = std::min({0.02, width / 60.0, 0.3 / std::abs(t)});
  double sum = 0.0;
  for (double u = -45.0 * std::max(width, 1.0 / df); u < 12.0 * width + 2.0; u += step) {
    const double density = std::exp(constant + df * u - 0.5 * df * std::exp(2.0 * u));
    const double z = t * std::exp(u) - delta;
    sum += density * 0.5 * std::erfc((upper ? z : -z) / std::numbers::sqrt2);
  }
  return sum * step;
}

TEST(NoncentralT, IsTheIntegralOfItsDefinition) {
  for (const double df : {1.0, 3.0, 24.0, 200.0}) {
    for (const double delta : {-2.0, 0.0, 0.7, 6.0, 25.0}) {
      for (const double t : {-4.0, -0.5, 0.2, 3.0, 11.0}) {
        const Tails tails = noncentral_t(t, df, delta);
        EXPECT_NEAR(tails.lower, quadrature(t, df, delta, false), 2e-13) << t << " " << delta;
        EXPECT_NEAR(tails.upper, quadrature(t, df, delta, true), 2e-13) << t << " " << delta;
      }
    }
  }
}

TEST(NoncentralT, KeepsItsDigitsInThinTails) {
  for (const auto& [t, df, delta] :
       {std::tuple{25.0, 100.0, 4.0}, {40.0, 60.0, 12.0}, {9.0, 30.0, 0.5}}) {
    const double expected = quadrature(t, df, delta, true);
    EXPECT_LT(expected, 1e-7);
    EXPECT_NEAR(noncentral_t(t, df, delta).upper / expected, 1.0, 1e-11);
  }
  const double expected = quadrature(5.0, 40.0, 20.0, false);
  EXPECT_LT(expected, 1e-15);
  EXPECT_NEAR(noncentral_t(5.0, 40.0, 20.0).lower / expected, 1.0, 1e-10);
}

TEST(NoncentralT, TakesEffectsFarLargerThanAnyoneMeasures) {
  const double t = 3100.0;
  const double delta = 3000.0;
  // For so large a t only the spread of S matters: T < t is S > (delta + Z) / t.
  EXPECT_NEAR(noncentral_t(t, 20.0, delta).lower, quadrature(t, 20.0, delta, false), 1e-10);
  EXPECT_NEAR(noncentral_t(t, 20.0, delta).lower + noncentral_t(t, 20.0, delta).upper, 1.0, 1e-10);
}

TEST(NoncentralF, OfOneDegreeOfFreedomIsTheSquareOfT) {
  for (const double df : {1.0, 7.5, 60.0}) {
    for (const double delta : {0.0, 0.4, 3.0, 15.0}) {
      for (const double f : {0.01, 1.0, 4.5, 90.0}) {
        const double root = std::sqrt(f);
        const double outside =
            noncentral_t(root, df, delta).upper + noncentral_t(-root, df, delta).lower;
        EXPECT_NEAR(noncentral_f(f, 1.0, df, delta * delta).upper, outside, 1e-13);
      }
    }
  }
}

TEST(NoncentralF, TailsAddUpAndTheLowerFallsWithNoncentrality) {
  for (const double n : {2.0, 9.0}) {
    double previous = 1.0;
    for (const double lambda : {0.0, 1e-6, 0.5, 8.0, 90.0, 4000.0, 1e6, 1e10}) {
      const Tails tails = noncentral_f(6.0, n, 18.0, lambda);
      EXPECT_NEAR(tails.lower + tails.upper, 1.0, 1e-12) << lambda;
      EXPECT_LE(tails.lower, previous);
      previous = tails.lower;
    }
  }
}

TEST(NoncentralF, IsCentralWithoutNoncentrality) {
  // With two degrees of freedom above, the tail has a closed form.
  EXPECT_NEAR(noncentral_f(3.0, 2.0, 8.0, 0.0).upper, std::pow(1.75, -4.0), 1e-15);
  EXPECT_EQ(noncentral_f(0.0, 3.0, 8.0, 2.0).lower, 0.0);
}

TEST(IncompleteBeta, HasItsClosedForms) {
  for (const double x : {1e-12, 0.1, 0.5, 0.97}) {
    const double y = 1.0 - x;
    EXPECT_NEAR(beta_tails(1.0, 3.0, x, y).upper, y * y * y, 1e-15);
    EXPECT_NEAR(beta_tails(4.0, 1.0, x, y).lower, x * x * x * x, 1e-15);
    EXPECT_NEAR(beta_tails(0.5, 0.5, x, y).lower, 2.0 / std::numbers::pi * std::asin(std::sqrt(x)),
                1e-15);
  }
  EXPECT_NEAR(poisson_power(3.0, 2.0), std::exp(-2.0) * 8.0 / 6.0, 1e-16);
}

TEST(NoncentralLimits, LeaveTheirTails) {
  for (const auto& [t, df] : {std::pair{2.1, 9.0}, {-0.3, 40.0}, {0.0, 5.0}, {55.0, 3.0}}) {
    const auto limits = noncentral_t_limits(t, df, 0.95);
    ASSERT_TRUE(limits);
    EXPECT_NEAR(noncentral_t(t, df, limits->low).upper, 0.025, 1e-13);
    EXPECT_NEAR(noncentral_t(t, df, limits->high).lower, 0.025, 1e-13);
  }
  const auto limits = noncentral_f_limits(9.0, 2.0, 30.0, 0.9);
  EXPECT_NEAR(noncentral_f(9.0, 2.0, 30.0, limits->low).upper, 0.05, 1e-13);
  EXPECT_NEAR(noncentral_f(9.0, 2.0, 30.0, limits->high).lower, 0.05, 1e-13);
}

TEST(NoncentralLimits, EndAtZeroAndAtWhatCanBeComputed) {
  const auto weak = noncentral_f_limits(1.0, 2.0, 30.0, 0.9);
  EXPECT_EQ(weak->low, 0.0);
  EXPECT_GT(weak->high, 0.0);
  EXPECT_EQ(noncentral_f_limits(0.01, 2.0, 30.0, 0.9)->high, 0.0);
  EXPECT_GT(noncentral_t_limits(30000.0, 12.0, 0.95)->low, 10000.0);
  EXPECT_THAT(noncentral_t_limits(1e6, 12.0, 0.95).because(), HasSubstr("too large"));
  EXPECT_THAT(noncentral_f_limits(1e12, 2.0, 9.0, 0.9).because(), HasSubstr("too large"));
}

}  // namespace
}  // namespace haptrial::analysis
