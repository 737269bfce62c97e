#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "analysis/coefficient.h"
#include "analysis/defined.h"

namespace haptrial::analysis {

/// A linear mixed model with a random intercept for each group (participant), by REML:
///
///     y_ij = b_0 + x_ij' b + u_i + e_ij,   u_i ~ N(0, between),   e_ij ~ N(0, within)
struct MixedModel {
  std::vector<Coefficient> coefficients;  // intercept, then the predictors; Satterthwaite's df
  double variance_between{0.0};           // of the groups' intercepts
  double variance_within{0.0};
  double log_likelihood{0.0};  // restricted, at its maximum
  std::size_t observations{0};
  std::size_t groups{0};
  bool at_boundary{false};  // variance_between is 0: df are observations less coefficients
};

/// @param predictors  (observations x predictors) without a column for the intercept; may be none.
///                    Any coding of the conditions.
/// @param groups      (observations) which group, any numbers.
/// Undefined when a value is not finite, there is one group or only groups of one, there are not
/// more observations than coefficients, a predictor does not vary or follows from others, or
/// nothing varies within the groups, or groups and predictors go together so that a coefficient has
/// no degrees of freedom.
/// @throws std::invalid_argument when the lengths differ.
/// Source: Laird and Ware 1982, Biometrics 38; the likelihood profiled over between / within, as
/// Bates et al. 2015, Journal of Statistical Software 67; degrees of freedom: Giesbrecht and Burns
/// 1985, Biometrics 41.
Defined<MixedModel> random_intercept_model(std::span<const double> response,
                                           const Eigen::MatrixXd& predictors,
                                           std::span<const std::size_t> groups,
                                           double level = 0.95);

}  // namespace haptrial::analysis
