// Fits behind a certificate, against results in closed form.

#include "analysis/device/least_squares.h"

#include <gtest/gtest.h>

#include <cmath>

#include "analysis/device/derivatives.h"
#include "core/base/random.h"

namespace haptrial::analysis {
namespace {

using Eigen::VectorXd;

TEST(LeastSquaresTest, AStraightLineHasTheErrorsOfTheTextbook) {
  RandomStream random(3, "line");
  constexpr long kCount = 50;
  VectorXd x(kCount), y(kCount);
  for (long i = 0; i < kCount; ++i) {
    x[i] = 0.1 * static_cast<double>(i);
    y[i] = 2.0 - 0.5 * x[i] + 0.3 * random.normal();
  }
  const FittedParameters fit = fit_least_squares(
      VectorXd::Zero(2), VectorXd::Ones(2), kCount,
      [&](const VectorXd& p, VectorXd& r) { r = (y.array() - p[0] - p[1] * x.array()).matrix(); });
  const double mx = x.mean(), my = y.mean();
  const double sxx = (x.array() - mx).square().sum();
  const double slope = ((x.array() - mx) * (y.array() - my)).sum() / sxx;
  const double left = (y.array() - my - slope * (x.array() - mx)).square().sum();
  EXPECT_NEAR(fit.value[1], slope, 1e-8);
  EXPECT_NEAR(fit.value[0], my - slope * mx, 1e-8);
  EXPECT_NEAR(std::sqrt(fit.covariance(1, 1)), std::sqrt(left / (kCount - 2) / sxx), 1e-8);
  EXPECT_EQ(fit.df, kCount - 2.0);
  constexpr double kT48 = 2.010635;  // of 97.5 %, from a table
  EXPECT_NEAR(fit.interval(1).high - slope, kT48 * std::sqrt(fit.covariance(1, 1)), 1e-6);
}

TEST(LeastSquaresTest, CorrelatedErrorsWidenTheInterval) {
  RandomStream random(5, "mean");
  constexpr long kCount = 20000;
  constexpr double kShare = 0.8;
  VectorXd y(kCount);
  double error = 0.0;
  for (long i = 0; i < kCount; ++i) {
    error = kShare * error + random.normal();
    y[i] = error;
  }
  const auto fit = [&](bool in_time) {
    return fit_least_squares(
        VectorXd::Zero(1), VectorXd::Ones(1), kCount,
        [&](const VectorXd& p, VectorXd& r) { r = (y.array() - p[0]).matrix(); }, in_time);
  };
  const double stretch = fit(true).covariance(0, 0) / fit(false).covariance(0, 0);
  EXPECT_NEAR(stretch, (1.0 + kShare) / (1.0 - kShare), 1.5) << "of a first-order process";
}

TEST(LeastSquaresTest, AnExponentialIsFoundFromAfar) {
  VectorXd y(40);
  for (long i = 0; i < y.size(); ++i) {
    y[i] = 3.0 * std::exp(-0.07 * static_cast<double>(i));
  }
  const FittedParameters fit =
      fit_least_squares((VectorXd(2) << 1.0, 0.5).finished(), VectorXd::Ones(2), y.size(),
                        [&](const VectorXd& p, VectorXd& r) {
                          for (long i = 0; i < y.size(); ++i) {
                            r[i] = y[i] - p[0] * std::exp(-p[1] * static_cast<double>(i));
                          }
                        });
  EXPECT_NEAR(fit.value[0], 3.0, 1e-6);
  EXPECT_NEAR(fit.value[1], 0.07, 1e-6);
}

TEST(DerivativesTest, APolynomialOfDegreeFiveHasItsOwnDerivatives) {
  constexpr double kRate = 200.0;
  constexpr long kHalf = 7;
  const Eigen::MatrixXd weights = derivative_weights(kHalf, kRate, 5);
  double first = 0.0, second = 0.0, value = 0.0;
  for (long i = -kHalf; i <= kHalf; ++i) {
    const double t = static_cast<double>(i) / kRate;
    const double x = 1.0 + 2.0 * t - 3.0 * t * t + 40.0 * std::pow(t, 3) - 500.0 * std::pow(t, 5);
    first += weights(i + kHalf, 0) * x;
    second += weights(i + kHalf, 1) * x;
    value += weights(i + kHalf, 2) * x;
  }
  EXPECT_NEAR(value, 1.0, 1e-9);
  EXPECT_NEAR(first, 2.0, 1e-9);
  EXPECT_NEAR(second, -6.0, 1e-6);
}

TEST(DerivativesTest, SmoothedSecondDifferencesAreTheSecondDerivative) {
  constexpr double kRate = 200.0;
  constexpr long kHalf = 7;
  const VectorXd weights = derivative_weights(kHalf, kRate, 5).col(1);
  const VectorXd kernel = smoothing_of(weights, kRate);
  RandomStream random(8, "path");
  VectorXd x(2 * kHalf + 1);
  for (long i = 0; i < x.size(); ++i) {
    x[i] = random.normal();
  }
  double sum = 0.0;
  for (long i = 0; i < kernel.size(); ++i) {
    sum += kernel[i] * (x[i + 2] - 2.0 * x[i + 1] + x[i]) * kRate * kRate;
  }
  EXPECT_NEAR(sum, weights.dot(x), 1e-8 * std::abs(weights.dot(x)) + 1e-6);
  EXPECT_NEAR(kernel.sum(), 1.0, 1e-9);
}

}  // namespace
}  // namespace haptrial::analysis
