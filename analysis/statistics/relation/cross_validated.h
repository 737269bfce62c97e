#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "analysis/statistics/base/defined.h"

namespace haptrial::analysis {

/// Ridge regression: with predictors standardised on the data that are fitted, the b that minimise
///
///     sum_i (y_i - mean(y) - z_i' b)^2 + n lambda |b|^2
struct RidgeFit {
  Eigen::VectorXd mean;    // of each predictor
  Eigen::VectorXd scale;   // its standard deviation; 0: it does not vary and has no say
  Eigen::VectorXd slopes;  // for standardised predictors
  double intercept{0.0};   // mean(y)

  /// @param predictors  (observations x predictors)
  Eigen::VectorXd predict(const Eigen::MatrixXd& predictors) const;
};

/// @throws std::invalid_argument for other than one row a response, no rows, or lambda not above 0.
RidgeFit ridge_regression(const Eigen::VectorXd& response, const Eigen::MatrixXd& predictors,
                          double lambda);

/// How a prediction agrees with what it predicts.
struct Agreement {
  Defined<double> r{Undefined{""}};  // Pearson's
  double rmse{0.0};                  // in units of the response
};

struct CrossValidated {
  Eigen::VectorXd predicted;      // each without its own group
  Eigen::VectorXd resubstituted;  // fitted to all, tested on the same
  Agreement validated;
  Agreement resubstitution;
  /// 1 - sum (y - predicted)^2 / sum (y - mean of the other groups)^2: what the predictors add to
  /// knowing the others' mean; 0 or below where they add nothing. R has no such zero: even noise,
  /// with the mean of the others as its prediction, has an R of about -1.
  double gain{0.0};
  std::vector<double>
      lambdas;         // that each left-out group's fit chose, groups in order of first row
  double lambda{0.0};  // that the fit to all chose
  RidgeFit fit;        // to all
};

/// Penalties to choose from: 0.01 to 1000, three a decade.
std::vector<double> ridge_penalties();

/// Leaves out each group (participant) in turn, all of its rows at once: standardising, choosing
/// lambda (by leaving out each of the remaining groups in turn, least squared error) and fitting
/// see nothing of it.
/// @param groups  (observations) which group, any numbers
/// Undefined with fewer than four groups, no predictors, a value that is not finite, or a response
/// that does not vary. @throws std::invalid_argument when lengths differ or there are no penalties.
/// Source: Hoerl and Kennard 1970, Technometrics 12; Stone 1974, Journal of the Royal Statistical
/// Society B 36; why the choice is inside: Varma and Simon 2006, BMC Bioinformatics 7.
Defined<CrossValidated> cross_validated_ridge(
    std::span<const double> response, const Eigen::MatrixXd& predictors,
    std::span<const std::size_t> groups, std::span<const double> penalties = ridge_penalties());

}  // namespace haptrial::analysis
