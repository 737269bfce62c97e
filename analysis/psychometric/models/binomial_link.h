#pragma once

#include <Eigen/Core>

#include "analysis/psychometric/models/binomial_data.h"

namespace haptrial::analysis {

/// Quantities of each row, at its linear predictor, for scoring.
struct BinomialRows {
  double log_likelihood{0.0};  // without binomial coefficients
  Eigen::VectorXd slope;       // (rows) d log-likelihood / d eta
  Eigen::VectorXd weight;      // (rows) Fisher's information about eta
};

/// @param eta  (rows). Not finite: the likelihood is 0 there.
BinomialRows binomial_rows(const BinomialData& data, BinomialLink link, const Eigen::VectorXd& eta);

/// Sum of the logarithms of the binomial coefficients.
double log_binomials(const BinomialData& data);

/// A column of ones before the predictors. @throws std::invalid_argument as binomial_regression.
Eigen::MatrixXd checked_columns(const BinomialData& data);

}  // namespace haptrial::analysis
