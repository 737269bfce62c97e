#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "analysis/psychometric/models/binomial_model.h"

namespace haptrial::analysis {

/// The rows of one participant.
struct BinomialGroup {
  BinomialData data;       // predictors are not used
  Eigen::MatrixXd fixed;   // (rows x p)
  Eigen::MatrixXd random;  // (rows x q)
};

/// The most probable u ~ N(0, I) of a participant, b = lower u.
struct LaplaceMode {
  double log_likelihood{0.0};  // Laplace's, without binomial coefficients
  Eigen::VectorXd u;           // (q)
  Eigen::VectorXd weight;      // (rows) Fisher's information about eta
  Eigen::MatrixXd factor;      // (q x q) L of L L' = I + lower' random' W random lower
};

/// Penalised scoring. Nothing where it does not end.
std::optional<LaplaceMode> laplace_mode(const BinomialGroup& group, BinomialLink link,
                                        const Eigen::VectorXd& beta, const Eigen::MatrixXd& lower);

/// A lower triangle from its elements, by columns.
Eigen::MatrixXd lower_triangle(const Eigen::VectorXd& elements, Eigen::Index size);

}  // namespace haptrial::analysis
