#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "analysis/statistics/base/defined.h"

namespace haptrial::analysis {

/// g(P) = predictors times coefficients.
enum class BinomialLink { kProbit, kLogit };

/// Answers and what they depend on, a row for each group of trials that share all of it.
struct BinomialData {
  std::vector<int> yes;        // (rows) >= 0
  std::vector<int> trials;     // (rows) >= yes, > 0
  Eigen::MatrixXd predictors;  // (rows x predictors) without a column for the intercept
};

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

/// Quantities of each row, at its linear predictor, for scoring.
struct BinomialRows {
  double log_likelihood{0.0};  // without binomial coefficients
  Eigen::VectorXd slope;       // (rows) d log-likelihood / d eta
  Eigen::VectorXd weight;      // (rows) Fisher's information about eta
};

/// @param eta  (rows). Not finite: the likelihood is 0 there.
BinomialRows binomial_rows(const BinomialData& data, BinomialLink link, const Eigen::VectorXd& eta);

/// Log-likelihood of the observed shares, without binomial coefficients.
double log_likelihood_of_shares(const BinomialData& data);

/// Sum of the logarithms of the binomial coefficients.
double log_binomials(const BinomialData& data);

/// A column of ones before the predictors. @throws std::invalid_argument as binomial_regression.
Eigen::MatrixXd checked_columns(const BinomialData& data);

/// The logarithm of a likelihood at some parameters.
struct ScoringPoint {
  double value{0.0};
  Eigen::VectorXd slope;
  Eigen::MatrixXd information;  // Fisher's
};

/// Where a likelihood is highest.
struct ScoringMaximum {
  Eigen::VectorXd at;
  ScoringPoint point;
};

/// Nothing where the parameters are out of their range.
using ScoredLikelihood = std::function<std::optional<ScoringPoint>(const Eigen::VectorXd&)>;

/// Fisher's scoring with halved steps. Nothing if the likelihood rises without end (a parameter
/// beyond 50 in size) or its information is singular.
std::optional<ScoringMaximum> fisher_scoring(const ScoredLikelihood& likelihood,
                                             const Eigen::VectorXd& start);

}  // namespace haptrial::analysis
