#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/base/random.h"

namespace haptrial::analysis::hierarchical {

/// A multivariate t distribution with four degrees of freedom, around which elliptical slices are
/// drawn. Its tails are long, so that a slice leaves places that it takes for improbable.
/// Source: Nishihara, Murray and Adams 2014, J. Machine Learning Research 15, 2087.
class TEllipse {
 public:
  TEllipse() = default;
  /// @param precision  inverse of the scale matrix, positive definite
  TEllipse(Eigen::VectorXd centre, const Eigen::MatrixXd& precision)
      : centre_(std::move(centre)), root_(precision.llt().matrixU()) {}

  double log_density(const Eigen::VectorXd& at) const;  // up to a constant

  /// Draws the next point of a chain on a target density, whatever the t distribution is.
  /// @param log_target  of `start`
  /// @param target      log-density at a point; the last call is for the point that is returned
  template <class Target>
  Eigen::VectorXd draw(const Eigen::VectorXd& start, double log_target, RandomStream& random,
                       Target&& target) const;

 private:
  /// Distance from the centre to a point that spans an ellipse with `at`.
  Eigen::VectorXd partner(const Eigen::VectorXd& at, RandomStream& random) const;

  Eigen::VectorXd centre_;
  Eigen::MatrixXd root_;  // upper triangle U: the precision is U' U
};

/// Learns such a distribution from draws.
class EllipseLearner {
 public:
  void add(const Eigen::VectorXd& draw);
  Eigen::Index count() const noexcept { return count_; }
  /// @returns the distribution with the draws' mean and covariance, in which correlations are drawn
  /// towards 0 as few draws tell them badly
  TEllipse learnt() const;

 private:
  Eigen::Index count_{0};
  Eigen::VectorXd sum_;
  Eigen::MatrixXd products_;
};

template <class Target>
Eigen::VectorXd TEllipse::draw(const Eigen::VectorXd& start, double log_target,
                               RandomStream& random, Target&& target) const {
  constexpr double kTurn = 2.0 * std::numbers::pi, kSmallest = 1e-9;
  const Eigen::VectorXd away = start - centre_, other = partner(start, random);
  const double height = log_target - log_density(start) + std::log(1.0 - random.uniform());
  double angle = random.uniform(0.0, kTurn), low = angle - kTurn, high = angle;
  while (high - low > kSmallest) {
    Eigen::VectorXd next = centre_ + away * std::cos(angle) + other * std::sin(angle);
    if (target(next) - log_density(next) > height) {
      return next;
    }
    (angle < 0.0 ? low : high) = angle;
    angle = random.uniform(low, high);
  }
  target(start);
  return start;
}

}  // namespace haptrial::analysis::hierarchical
