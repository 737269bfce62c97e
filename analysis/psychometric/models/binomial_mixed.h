#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "analysis/psychometric/models/binomial_model.h"
#include "analysis/statistics/base/defined.h"

namespace haptrial::analysis {

/// g(P) = x' beta + z' b, with b ~ N(0, random_covariance) for each participant.
struct BinomialMixedModel {
  /// Covariance of the coefficients from the information at the estimated random_covariance.
  BinomialModel fixed;
  Eigen::MatrixXd random_covariance;  // (q x q) in the order of `random`
  Eigen::MatrixXd effects;            // (participants x q) most probable b, participants rising
  std::vector<std::size_t> participants;
  int parameters{0};        // coefficients, variances and covariances
  bool at_boundary{false};  // random_covariance is singular (lme4: a singular fit)
};

/// Fits by maximum likelihood in Laplace's approximation, the integral over b replaced by a normal
/// one around the most probable b with Fisher's information, as lme4's glmer does (nAGQ = 1).
/// All variances and covariances of the random columns are free.
/// @param random  columns with a random effect: 0 the intercept, k predictor k; different.
///                Of psychometric functions intercept and slope: where only intercepts vary in the
///                model but slopes vary between people, its errors are too small.
/// @param participants  of each row, any numbers.
/// Undefined as binomial_regression, with one participant, and where the search does not end.
/// @throws std::invalid_argument when lengths differ, naming `random` or the count that breaks its
/// bound. Source: Bates et al. 2015, Journal of Statistical Software 67; Moscatelli, Mezzetti and
/// Lacquaniti 2012, Journal of Vision 12(11), 26.
Defined<BinomialMixedModel> binomial_mixed_model(const BinomialData& data, BinomialLink link,
                                                 std::span<const std::size_t> participants,
                                                 std::span<const std::size_t> random,
                                                 double level = 0.95);

}  // namespace haptrial::analysis
