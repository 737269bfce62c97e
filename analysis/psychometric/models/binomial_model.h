#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "analysis/psychometric/models/binomial_data.h"
#include "analysis/statistics/base/defined.h"

namespace haptrial::analysis {

/// A coefficient with its normal interval.
struct BinomialCoefficient {
  double estimate{0.0};
  double error{0.0};
  double z{0.0};
  double p{1.0};  // two-sided
  double low{0.0}, high{0.0};
};

struct BinomialModel {
  std::vector<BinomialCoefficient> coefficients;  // the intercept first
  Eigen::MatrixXd covariance;                     // of the coefficients
  double log_likelihood{0.0};                     // with binomial coefficients
  double deviance{0.0};                           // against the observed shares
  std::size_t observations{0};                    // rows
  double level{0.95};
};

/// Probit or logit regression by maximum likelihood (Fisher's scoring).
/// Undefined when predictors follow from others, there are fewer rows than coefficients, a value is
/// not finite, or the predictors separate "yes" from "no", so that the likelihood has no maximum.
/// @param level  coverage of the intervals, inside (0, 1).
/// @throws std::invalid_argument when lengths differ, or naming the count that breaks its bound.
Defined<BinomialModel> binomial_regression(const BinomialData& data, BinomialLink link,
                                           double level = 0.95);

/// Place at which a rising function of one predictor crosses 1/2, and the distance from there to
/// 3/4.
struct EqualityPoint {
  double point{0.0};  // -intercept / slope
  double point_error{0.0}, point_low{0.0}, point_high{0.0};
  double jnd{0.0};  // g(3/4) / |slope|
  double jnd_error{0.0}, jnd_low{0.0}, jnd_high{0.0};
};

/// Equality point of the line intercept + slope x, both sums of coefficients, for example of one
/// condition; errors by the delta method.
/// @param intercept, slope  weights of the coefficients, as many as there are of these.
/// Undefined where the slope is 0. @throws std::invalid_argument when the lengths differ.
Defined<EqualityPoint> equality_point(const BinomialModel& model, BinomialLink link,
                                      const Eigen::VectorXd& intercept,
                                      const Eigen::VectorXd& slope);

/// Fills error, z, p and interval of each coefficient from the covariance.
void add_normal_tests(BinomialModel& model, const Eigen::VectorXd& estimates);

}  // namespace haptrial::analysis
