#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "analysis/statistics/base/defined.h"
#include "analysis/statistics/relation/correlation.h"

namespace haptrial::analysis {

/// An ordinary least-squares fit with an intercept.
struct Regression {
  std::vector<Coefficient> coefficients;  // intercept, then the predictors
  double df_error{0.0};
  double deviation{0.0};  // standard deviation of the residuals
  double r_squared{0.0};
  double adjusted_r_squared{0.0};
  double f{0.0};  // of all predictors together; df: their number and df_error
  double p{0.0};
};

/// @param predictors  (observations x predictors), at least one, without a column for the
/// intercept.
/// @param response    (observations).
/// Undefined when a value is not finite, there are not more observations than coefficients, a
/// predictor does not vary or follows from others, the response does not vary, or the fit is exact.
/// @throws std::invalid_argument when the lengths differ or there is no predictor.
Defined<Regression> linear_regression(const Eigen::MatrixXd& predictors,
                                      std::span<const double> response, double level = 0.95);

/// Regression with one predictor.
Defined<Regression> linear_regression(std::span<const double> predictor,
                                      std::span<const double> response, double level = 0.95);

}  // namespace haptrial::analysis
