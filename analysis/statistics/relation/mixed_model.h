#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "analysis/statistics/base/defined.h"
#include "analysis/statistics/relation/fitted_mixed_model.h"

namespace haptrial::analysis {

/// @param predictors  (observations x predictors) without a column for the intercept; may be none.
///                    Any coding of the conditions.
/// @param terms       of each random term the group of every observation, any numbers. None: the
///                    linear regression.
/// Undefined when a value is not finite, a term has one group or only groups of one, there are not
/// more observations than coefficients, a predictor does not vary or follows from others, nothing
/// varies within the groups, two terms group alike, or groups and predictors go together so that a
/// variance cannot be estimated or a coefficient has no degrees of freedom.
/// @throws std::invalid_argument when the lengths differ.
/// Source: Bates et al. 2015, Journal of Statistical Software 67; degrees of freedom: Giesbrecht
/// and Burns 1985, Biometrics 41; Kuznetsova et al. 2017, Journal of Statistical Software 82.
Defined<MixedModel> mixed_model(std::span<const double> response, const Eigen::MatrixXd& predictors,
                                const std::vector<std::vector<std::size_t>>& terms,
                                double level = 0.95);

/// The same with one term, of participants.
Defined<MixedModel> random_intercept_model(std::span<const double> response,
                                           const Eigen::MatrixXd& predictors,
                                           std::span<const std::size_t> groups,
                                           double level = 0.95);

}  // namespace haptrial::analysis
