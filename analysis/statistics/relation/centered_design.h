#pragma once

#include <Eigen/Core>
#include <span>

#include "analysis/statistics/base/defined.h"

namespace haptrial::analysis {

/// Predictors of a linear model with an intercept, each less its mean and scaled to unit length:
/// an offset common to a column costs no digits, and a column's unit does not matter.
struct CenteredDesign {
  Eigen::MatrixXd columns;  // (observations x predictors)
  Eigen::VectorXd means;    // (predictors)
  Eigen::VectorXd scales;   // (predictors), length of the column less its mean

  /// Coefficients of (1, predictors) from those of (1, columns): the matrix to multiply with.
  Eigen::MatrixXd back() const;  // (1 + predictors) squared
};

/// @param predictors  (observations x predictors), without the intercept; there may be none.
/// Undefined when a value is not finite, a predictor does not vary, or one is a linear combination
/// of others. Predictors are counted from 1.
Defined<CenteredDesign> centered_design(const Eigen::MatrixXd& predictors);

/// The squares that rounding of these values can leave in deviations that should be 0.
double rounding_of(std::span<const double> values);

/// Whether finite values differ by more than rounding makes of equal ones.
bool vary_beyond_rounding(std::span<const double> values);

}  // namespace haptrial::analysis
