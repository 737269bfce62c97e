#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace haptrial::psychometric {

/// Expectation about f before the first answer.
struct Smoothness {
  double slope;   // standard deviation of f's value and slopes
  double bend;    // of the Gaussian process that bends it, over that of the slopes
  double length;  // over which that changes; the cube is 2 wide
};

/// Terms whose sums are the smooth functions f over the cube -1 <= u_k <= 1: 1, each u_k, and sines
/// that stand for a Gaussian process with a squared exponential covariance (Solin and Särkkä 2020,
/// Statistics and Computing 30, who bound the error).
class SmoothBasis {
 public:
  /// @param dimensions  1 to 4
  explicit SmoothBasis(std::size_t dimensions);

  std::size_t dimensions() const noexcept { return dimensions_; }
  Eigen::Index size() const noexcept;
  /// @param u  one number a dimension; beyond the cube the terms of its edge
  Eigen::VectorXd at(const std::vector<double>& u) const;
  /// Their derivatives by u_k.
  Eigen::VectorXd slope(const std::vector<double>& u, std::size_t k) const;
  /// Standard deviation of each coefficient.
  Eigen::VectorXd deviations(const Smoothness& smoothness) const;

 private:
  std::size_t dimensions_;
  std::vector<std::vector<int>> waves_;  // half waves along each dimension, a sine a row
};

/// The probability of an answer: floor + share * Phi(sign * f).
struct ProbitLink {
  double floor{0.0};
  double share{1.0};
  double sign{1.0};
};

/// How an answer changes a normal distribution of f with mean m and variance v, if it is replaced
/// by the normal one of the same mean, m + v pull, and variance, v - v v bend.
struct ProbitChange {
  double probability;  // of the answer
  double pull, bend;   // bend >= 0
};
ProbitChange change_by(const ProbitLink& link, double m, double v) noexcept;

/// A belief about the coefficients: a normal distribution, and how each fact changed it.
/// A fact has the probability of its link; the distribution with it is replaced by the normal one
/// of the same mean and variance along the fact's row (assumed density filtering; expectation
/// propagation when facts are visited again: Minka 2001).
class SmoothBelief {
 public:
  explicit SmoothBelief(const Eigen::VectorXd& deviations);

  /// A visit takes `lost` h h' off the covariance, h the new covariance times the fact's row.
  struct Visit {
    double probability{1.0};  // of the fact, by all others
    double lost{0.0};
  };
  /// Takes in fact number `fact`, for the first time or anew.
  Visit visit(std::size_t fact, const Eigen::VectorXd& row, const ProbitLink& link);

  const Eigen::VectorXd& mean() const noexcept { return mean_; }
  const Eigen::MatrixXd& covariance() const noexcept { return covariance_; }

 private:
  /// A fact's share of the distribution, as if it were the normal of this precision and mean.
  struct NormalFactor {
    double precision{0.0}, shift{0.0};
  };
  Eigen::VectorXd mean_;
  Eigen::MatrixXd covariance_;
  std::vector<NormalFactor> facts_;
};

}  // namespace haptrial::psychometric
