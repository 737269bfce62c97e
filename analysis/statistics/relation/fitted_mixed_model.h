#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "analysis/statistics/relation/correlation.h"

namespace haptrial::analysis {

/// A linear mixed model with any number of random intercepts, crossed or nested, by REML:
///
///     y_i = b_0 + x_i' b + sum_k u_k[group of i in term k] + e_i
///     u_k ~ N(0, variances[k]),   e ~ N(0, variance_within)
struct MixedModel {
  std::vector<Coefficient> coefficients;  // intercept, then the predictors; Satterthwaite's df
  std::vector<double> variances;          // of the terms' intercepts, in the order given
  std::vector<std::size_t> groups;        // of each term
  double variance_within{0.0};
  double log_likelihood{0.0};  // restricted, at its maximum
  std::size_t observations{0};
  bool at_boundary{false};  // some variance is 0: the fit is that without its term

  // Matrices for contrasts. The parameters are the logarithms of variance_within and of the
  // positive variances' ratios to it.
  Eigen::MatrixXd root;                   // covariance of the coefficients = root root'
  std::vector<Eigen::MatrixXd> leverage;  // its slope by parameter m = root leverage[m] root'
  Eigen::MatrixXd parameters;             // covariance of the parameters
};

}  // namespace haptrial::analysis
