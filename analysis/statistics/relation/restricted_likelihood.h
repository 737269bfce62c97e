#pragma once

#include <Eigen/Core>
#include <vector>

#include "analysis/statistics/relation/random_blocks.h"

namespace haptrial::analysis {

/// The restricted likelihood of a linear model with random intercepts over the ratios
/// rho_k = (variance of term k) / (residual variance), the residual variance profiled out:
///
///     criterion(rho) = -2 log likelihood,   V = I + sum_k rho_k Z_k Z_k'
///
/// Source: Bates et al. 2015, Journal of Statistical Software 67, for the profiled criterion;
/// Searle, Casella and McCulloch 1992, Variance Components, ch. 6, for its derivatives.
class RestrictedLikelihood {
 public:
  /// @param columns   (observations x p), without the intercept.
  /// @param response  (observations).
  /// @param terms     K groupings of the observations; may be none.
  RestrictedLikelihood(const Eigen::MatrixXd& columns, const Eigen::VectorXd& response,
                       const std::vector<Grouping>& terms);

  /// The fit at one rho. The coefficients are 1 + p, the intercept first.
  struct Point {
    Eigen::VectorXd rho;           // (K)
    double criterion{0.0};         // but for the scaling of the columns
    double within{0.0};            // estimate of the residual variance
    Eigen::VectorXd coefficients;  // (1 + p)
    Eigen::MatrixXd root;  // (1 + p) squared: covariance of the coefficients = within root root'
  };
  /// The same with P = V^-1 - V^-1 X (X'V^-1 X)^-1 X'V^-1 and u_k = Z_k' P response.
  struct Slopes : Point {
    Eigen::VectorXd slope;                  // (K) of the criterion
    Eigen::MatrixXd hessian;                // (K x K) of the criterion
    Eigen::MatrixXd expected;               // (K x K) information on the rhos; semidefinite
    Eigen::VectorXd effects;                // (K) |u_k|^2
    std::vector<Eigen::MatrixXd> leverage;  // (K) of root' X'V^-1 Z_k Z_k'V^-1 X root
  };
  Point value(const Eigen::VectorXd& rho) const;
  Slopes at(const Eigen::VectorXd& rho) const;

  Eigen::Index terms() const { return terms_; }
  double df() const { return df_; }  // observations - 1 - p
  /// Residual squares beside the predictors and a fixed effect for every group: the limit of large
  /// rhos.
  double within_squares() const;

 private:
  struct Whitened;
  Point solved(const Eigen::VectorXd& rho, std::vector<Whitened>* kept) const;

  RandomBlocks data_;
  Eigen::Index terms_{0};
  Eigen::Index rows_{0};  // of all blocks and deviations
  double df_{0.0};
};

}  // namespace haptrial::analysis
