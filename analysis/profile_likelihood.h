#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>

namespace haptrial::analysis {

/// The restricted likelihood of a random-intercept model over one number, rho = between / within.
///
/// The covariance of a group of n values is within (I + rho J): deviations from the group's mean
/// keep the weight 1, the mean gets n / (1 + n rho). So the values are split once into deviations,
/// reduced by QR, and means; each rho costs a QR of (predictors + groups) rows.
class ProfileLikelihood {
 public:
  /// @param columns   (observations x p), without the intercept.
  /// @param response  (observations).
  /// @param groups    (observations) 0 .. number of groups - 1, each present.
  ProfileLikelihood(const Eigen::MatrixXd& columns, const Eigen::VectorXd& response,
                    std::span<const std::size_t> groups);

  /// What belongs to one rho. The derivatives are those of criterion().
  struct Point {
    double rho{0.0};
    double criterion{0.0};         // -2 log likelihood, but for the scaling of the columns
    double slope{0.0};             // by rho
    double squares{0.0};           // weighted residual sum of squares
    double within{0.0};            // its estimate, squares / df
    Eigen::VectorXd coefficients;  // intercept first
    Eigen::MatrixXd root;          // (1 + p) upper triangular: covariance = within root root'
    Eigen::VectorXd effects;       // (groups) Z' V^-1 residual
    Eigen::MatrixXd leverage;      // (groups x 1 + p) Z' V^-1 X root
    Eigen::VectorXd weights;       // (groups) n / (1 + n rho)
  };
  Point at(double rho) const;

  /// Residual squares of the deviations within groups alone: the limit of large rho.
  double within_squares() const { return within_squares_; }
  double df() const { return df_; }  // observations - 1 - p

 private:
  Eigen::MatrixXd deviations_;  // (p + 1 x p + 2) R of (0, columns, response) within groups
  Eigen::MatrixXd means_;       // (groups x p + 2) of (1, columns, response)
  Eigen::VectorXd counts_;      // (groups)
  double df_{0.0};
  double within_squares_{0.0};
};

}  // namespace haptrial::analysis
