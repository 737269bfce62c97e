#include "analysis/statistics/relation/regression.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/base/random.h"

namespace haptrial::analysis::regression_test {
namespace {

using Eigen::MatrixXd;
using testing::HasSubstr;
using Values = std::vector<double>;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(Regression, MatchesACaseWorkedByHand) {
  // Means 2 and 2; Sxx 2, Sxy 1, Syy 2: slope 1/2, residuals -1/2, 1, -1/2.
  const auto fit = linear_regression(Values{1, 2, 3}, Values{1, 3, 2});
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->coefficients[0].estimate, 1.0, 1e-14);
  EXPECT_NEAR(fit->coefficients[1].estimate, 0.5, 1e-15);
  EXPECT_NEAR(fit->deviation, std::sqrt(1.5), 1e-15);
  EXPECT_NEAR(fit->coefficients[1].error, std::sqrt(0.75), 1e-15);
  EXPECT_NEAR(fit->coefficients[0].error, std::sqrt(1.5 * (1.0 / 3.0 + 2.0)), 1e-14);
  EXPECT_NEAR(fit->r_squared, 0.25, 1e-15);
  EXPECT_NEAR(fit->f, 1.0 / 3.0, 1e-15);
  EXPECT_NEAR(fit->coefficients[1].p, fit->p, 1e-14);
}

// NIST StRD, Longley: seven certified coefficients of nearly collinear predictors.
TEST(Regression, ReachesTheCertifiedValuesOfLongley) {
  MatrixXd x(16, 6);
  x << 83.0, 234289, 2356, 1590, 107608, 1947,  //
      88.5, 259426, 2325, 1456, 108632, 1948,   //
      88.2, 258054, 3682, 1616, 109773, 1949,   //
      89.5, 284599, 3351, 1650, 110929, 1950,   //
      96.2, 328975, 2099, 3099, 112075, 1951,   //
      98.1, 346999, 1932, 3594, 113270, 1952,   //
      99.0, 365385, 1870, 3547, 115094, 1953,   //
      100.0, 363112, 3578, 3350, 116219, 1954,  //
      101.2, 397469, 2904, 3048, 117388, 1955,  //
      104.6, 419180, 2822, 2857, 118734, 1956,  //
      108.4, 442769, 2936, 2798, 120445, 1957,  //
      110.8, 444546, 4681, 2637, 121950, 1958,  //
      112.6, 482704, 3813, 2552, 123366, 1959,  //
      114.2, 502601, 3931, 2514, 125368, 1960,  //
      115.7, 518173, 4806, 2572, 127852, 1961,  //
      116.9, 554894, 4007, 2827, 130081, 1962;
  const Values y{60323, 61122, 60171, 61187, 63221, 63639, 64989, 63761,
                 66019, 67857, 68169, 66513, 68655, 69564, 69331, 70551};
  const auto fit = linear_regression(x, y);
  ASSERT_TRUE(fit) << fit.because();
  const Values certified{-3482258.63459582, 15.0618722713733,  -0.358191792925910e-01,
                         -2.02022980381683, -1.03322686717359, -0.511041056535807e-01,
                         1829.15146461355};
  for (std::size_t k = 0; k < certified.size(); ++k) {
    EXPECT_NEAR(fit->coefficients[k].estimate / certified[k], 1.0, 1e-11) << k;
  }
  EXPECT_NEAR(fit->deviation / 304.854073561965, 1.0, 1e-12);
  EXPECT_NEAR(fit->r_squared, 0.995479004577296, 1e-14);
}

TEST(Regression, DoesNotMindAnOffset) {
  RandomStream random(1, "offset");
  MatrixXd x(40, 2);
  Values y;
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    x(i, 0) = std::round(64.0 * random.normal()) / 64.0;
    x(i, 1) = std::round(64.0 * random.normal()) / 64.0;
    y.push_back(std::round(64.0 * (x(i, 0) - 2.0 * x(i, 1) + random.normal())) / 64.0);
  }
  const auto plain = linear_regression(x, y);
  x.array() += 1e12;
  for (auto& value : y) {
    value += 1e12;
  }
  const auto moved = linear_regression(x, y);
  ASSERT_TRUE(moved) << moved.because();
  for (const std::size_t k : {1u, 2u}) {
    EXPECT_NEAR(moved->coefficients[k].estimate, plain->coefficients[k].estimate, 1e-13);
    EXPECT_NEAR(moved->coefficients[k].error, plain->coefficients[k].error, 1e-14);
    EXPECT_NEAR(moved->coefficients[k].p, plain->coefficients[k].p, 1e-13);
  }
  EXPECT_NEAR(moved->r_squared, plain->r_squared, 1e-13);
}

TEST(Regression, ResidualsAreOrthogonalToThePredictors) {
  RandomStream random(2, "normal equations");
  MatrixXd x(30, 3);
  Values y;
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    for (Eigen::Index j = 0; j < x.cols(); ++j) {
      x(i, j) = random.normal() + 10.0;
    }
    y.push_back(random.normal());
  }
  const auto fit = linear_regression(x, y);
  Eigen::VectorXd residuals = Eigen::VectorXd::Map(y.data(), 30);
  residuals.array() -= fit->coefficients[0].estimate;
  for (Eigen::Index j = 0; j < x.cols(); ++j) {
    residuals -= fit->coefficients[static_cast<std::size_t>(j) + 1].estimate * x.col(j);
  }
  EXPECT_NEAR(residuals.sum(), 0.0, 1e-12);
  EXPECT_LT((x.transpose() * residuals).norm(), 1e-11);
  EXPECT_NEAR(residuals.squaredNorm() / 26.0, fit->deviation * fit->deviation, 1e-13);
}

TEST(Regression, SaysWhyItIsNotDefined) {
  const Values x{1, 2, 3, 4}, y{2, 1, 4, 3};
  EXPECT_THAT(linear_regression(x, Values{1, 2, kNan, 3}).because(), HasSubstr("finite"));
  EXPECT_THAT(linear_regression(Values{1, 2, kNan, 3}, y).because(), HasSubstr("finite"));
  EXPECT_THAT(linear_regression(Values{5, 5, 5, 5}, y).because(),
              HasSubstr("predictor 1 does not vary"));
  EXPECT_THAT(linear_regression(x, Values{5, 5, 5, 5}).because(),
              HasSubstr("response does not vary"));
  EXPECT_THAT(linear_regression(Values{1, 2}, Values{2, 1}).because(), HasSubstr("coefficients"));
  EXPECT_THAT(linear_regression(Values{}, Values{}).because(), HasSubstr("no values"));
  EXPECT_THAT(linear_regression(x, Values{0.1, 0.3, 0.5, 0.7}).because(), HasSubstr("exact"));
  MatrixXd twice(5, 2);
  twice << 1, 2.1, 2, 4.1, 4, 8.1, 3, 6.1, 9, 18.1;
  EXPECT_THAT(linear_regression(twice, Values{1, 2, 4, 2, 7}).because(),
              HasSubstr("linear combination"));
  EXPECT_THROW(linear_regression(x, Values{1, 2}), std::invalid_argument);
  EXPECT_THROW(linear_regression(MatrixXd(4, 0), y), std::invalid_argument);
}

}  // namespace
}  // namespace haptrial::analysis::regression_test
