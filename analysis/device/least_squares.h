#pragma once

#include <Eigen/Core>
#include <functional>

#include "analysis/device/interval.h"

namespace haptrial::analysis {

/// Parameters at the least sum of squares, and how well they are known.
struct FittedParameters {
  Eigen::VectorXd value;       // (parameters)
  Eigen::MatrixXd covariance;  // (parameters x parameters)
  double df{0.0};              // residuals - parameters
  double chi_squared{0.0};     // least sum of squares

  Interval interval(int parameter) const;
  /// Interval of a smooth function of the parameters, by its slopes.
  Interval interval(const std::function<double(const Eigen::VectorXd&)>& function,
                    const Eigen::VectorXd& scale) const;
};

/// Fills the residuals for given parameters; always as many.
using Residuals =
    std::function<void(const Eigen::VectorXd& parameters, Eigen::VectorXd& residuals)>;

/// Nonlinear least squares by Levenberg and Marquardt. Residuals are taken as independent and of
/// one variance, but for their own autocorrelation, by whose time the covariance is stretched.
/// @param scale  size of a change of each parameter that matters, > 0 (parameters)
/// @param count  of residuals, more than parameters
/// @param ordered_in_time  whether neighbours may be correlated
FittedParameters fit_least_squares(const Eigen::VectorXd& start, const Eigen::VectorXd& scale,
                                   long count, const Residuals& residuals,
                                   bool ordered_in_time = false);

}  // namespace haptrial::analysis
