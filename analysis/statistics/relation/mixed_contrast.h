#pragma once

#include <Eigen/Core>

#include "analysis/statistics/base/defined.h"
#include "analysis/statistics/relation/fitted_mixed_model.h"

namespace haptrial::analysis {

/// A weighted sum of a model's coefficients held against 0.
/// @param weights  (coefficients).
/// Undefined if all weights are 0 or there are no degrees of freedom.
/// @throws std::invalid_argument when there are not as many weights as coefficients.
Defined<Coefficient> contrast(const MixedModel& model, const Eigen::VectorXd& weights,
                              double level = 0.95);

/// Satterthwaite's F test that several contrasts are all 0.
struct JointTest {
  double f{0.0};
  double df_numerator{0.0};  // independent contrasts
  double df_denominator{0.0};
  double p{0.0};
};

/// @param contrasts  (contrasts x coefficients). df_denominator depends a little on how the same
///                   hypothesis is written; f does not.
/// Undefined if all weights are 0.
/// @throws std::invalid_argument when there are not as many columns as coefficients.
/// Source: Fai and Cornelius 1996, Journal of Statistical Computation and Simulation 54;
/// Kuznetsova et al. 2017, Journal of Statistical Software 82.
Defined<JointTest> joint_test(const MixedModel& model, const Eigen::MatrixXd& contrasts);

/// The contrasts by which lmerTest's anova() tests the only factor of a model: each of its
/// predictors less what the ones before it explain.
/// @param predictors  (observations x predictors), independent.
/// @returns (predictors x 1 + predictors).
Eigen::MatrixXd sequential_contrasts(const Eigen::MatrixXd& predictors);

}  // namespace haptrial::analysis
