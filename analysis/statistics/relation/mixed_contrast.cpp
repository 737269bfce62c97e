#include "analysis/statistics/relation/mixed_contrast.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "analysis/statistics/base/decomposition.h"
#include "analysis/statistics/base/distributions.h"

namespace haptrial::analysis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

VectorXd estimates_of(const MixedModel& model) {
  VectorXd estimates(std::ssize(model.coefficients));
  std::transform(model.coefficients.begin(), model.coefficients.end(), estimates.begin(),
                 [](const Coefficient& c) { return c.estimate; });
  return estimates;
}

/// 2 v² / Var(v) of the variance v of a contrast.
/// @param rotated  root' times the contrast.
double satterthwaite(const MixedModel& model, const VectorXd& rotated) {
  const VectorXd unit = rotated.normalized();
  VectorXd slopes(std::ssize(model.leverage));  // of log v
  std::transform(model.leverage.begin(), model.leverage.end(), slopes.begin(),
                 [&](const MatrixXd& leverage) { return unit.dot(leverage * unit); });
  return 2.0 / slopes.dot(model.parameters * slopes);
}

/// The df of the F with the mean of a sum of squared t over their number.
double combined(const std::vector<double>& df) {
  if (df.size() == 1) {
    return df.front();
  }
  const double count = static_cast<double>(df.size());
  double sum = 0.0;
  double excess = 0.0;  // sum of df / (df - 2), less count, without cancellation
  for (const double each : df) {
    if (each <= 2.0) {
      return 2.0;
    }
    excess += 2.0 / (each - 2.0);
    sum += each;
  }
  // Infinite df in every direction leave no excess.
  return excess > 0.0 ? 2.0 * (count + excess) / excess : sum / count;
}

void check_columns(const MixedModel& model, Index columns) {
  if (columns != std::ssize(model.coefficients)) {
    throw std::invalid_argument("a contrast has not as many weights as the model coefficients");
  }
}

}  // namespace

Defined<Coefficient> contrast(const MixedModel& model, const VectorXd& weights, double level) {
  check_columns(model, weights.size());
  const VectorXd rotated = model.root.transpose() * weights;
  const double error = rotated.norm();
  if (!(error > 0.0)) {
    return Undefined{"the contrast has no weights"};
  }
  const double df = satterthwaite(model, rotated);
  if (!(df > 0.0 && std::isfinite(df))) {
    return Undefined{"the contrast has no degrees of freedom"};
  }
  return coefficient(weights.dot(estimates_of(model)), error, df, level);
}

Defined<JointTest> joint_test(const MixedModel& model, const MatrixXd& contrasts) {
  check_columns(model, contrasts.cols());
  // Independent contrasts: the eigenvectors of the covariance, as left singular vectors of its
  // root.
  const MatrixXd rotated = contrasts * model.root;
  const SymmetricEigen eigen = symmetric_eigen(rotated * rotated.transpose());
  const VectorXd& variances = eigen.values;  // rising
  const double largest = variances.size() > 0 ? variances[variances.size() - 1] : 0.0;
  const double smallest = std::sqrt(std::numeric_limits<double>::epsilon()) * largest;
  const VectorXd estimates = contrasts * estimates_of(model);
  JointTest test;
  std::vector<double> df;
  for (Index i = 0; i < variances.size(); ++i) {
    if (variances[i] > smallest) {
      const VectorXd direction = eigen.vectors.col(i);
      test.f += std::pow(direction.dot(estimates), 2) / variances[i];
      df.push_back(satterthwaite(model, rotated.transpose() * direction));
    }
  }
  if (df.empty()) {
    return Undefined{"the contrasts have no weights"};
  }
  test.df_numerator = static_cast<double>(df.size());
  test.f /= test.df_numerator;
  test.df_denominator = combined(df);
  if (!(test.df_denominator > 0.0 && std::isfinite(test.df_denominator))) {
    return Undefined{"the contrasts have no degrees of freedom"};
  }
  test.p = f_upper_tail(test.f, test.df_numerator, test.df_denominator);
  return test;
}

MatrixXd sequential_contrasts(const MatrixXd& predictors) {
  const Index p = predictors.cols();
  const MatrixXd centered = predictors.rowwise() - predictors.colwise().mean();
  const MatrixXd upper = cholesky(centered.transpose() * centered).value().transpose();
  MatrixXd contrasts = MatrixXd::Zero(p, 1 + p);
  contrasts.rightCols(p) = upper.diagonal().cwiseInverse().asDiagonal() * upper;
  return contrasts;
}

}  // namespace haptrial::analysis
