#include "analysis/statistics/relation/regression.h"

#include <cmath>
#include <stdexcept>

#include "analysis/statistics/base/decomposition.h"
#include "analysis/statistics/base/descriptive.h"
#include "analysis/statistics/base/distributions.h"
#include "analysis/statistics/relation/centered_design.h"

namespace haptrial::analysis {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// The regression of the centred response on the centred columns.
struct Fit : LeastSquares {
  double squares{0.0};
};

Fit fitted(const MatrixXd& columns, const VectorXd& response) {
  Fit fit{least_squares(columns, response)};
  fit.squares = (response - columns * fit.slopes).squaredNorm();
  return fit;
}

Regression summarized(const CenteredDesign& design, const Fit& fit, const Moments& response,
                      double df, double level) {
  const Eigen::Index p = fit.slopes.size();
  const double variance = fit.squares / df;
  VectorXd centred(1 + p);  // the mean response goes with the mean predictors
  centred << 0.0, fit.slopes;
  MatrixXd covariance = MatrixXd::Zero(1 + p, 1 + p);
  covariance(0, 0) = 1.0 / static_cast<double>(response.count);
  covariance.bottomRightCorner(p, p) = fit.inverse;
  const MatrixXd back = design.back();
  VectorXd estimates = back * centred;
  estimates[0] += response.mean();
  const VectorXd variances = (back * covariance).cwiseProduct(back).rowwise().sum() * variance;

  Regression result;
  for (Eigen::Index k = 0; k <= p; ++k) {
    result.coefficients.push_back(coefficient(estimates[k], std::sqrt(variances[k]), df, level));
  }
  const auto count = static_cast<double>(p);
  const double explained = (design.columns * fit.slopes).squaredNorm();
  result.df_error = df;
  result.deviation = std::sqrt(variance);
  result.r_squared = explained / (explained + fit.squares);
  result.adjusted_r_squared = 1.0 - (fit.squares / (explained + fit.squares)) * (df + count) / df;
  result.f = explained / count / variance;
  result.p = f_upper_tail(result.f, count, df);
  return result;
}

}  // namespace

Defined<Regression> linear_regression(const MatrixXd& predictors, std::span<const double> response,
                                      double level) {
  if (predictors.rows() != std::ssize(response) || predictors.cols() == 0) {
    throw std::invalid_argument("linear_regression: the lengths differ or there is no predictor");
  }
  const auto m = moments(response);
  if (!m) {
    return Undefined{m.because()};
  }
  const auto df = static_cast<double>(predictors.rows() - predictors.cols() - 1);
  if (df < 1.0) {
    return Undefined{"there are not more values than coefficients"};
  }
  const auto design = centered_design(predictors);
  if (!design) {
    return Undefined{design.because()};
  }
  const double rounding = rounding_of(response);
  if (m->squares <= rounding) {
    return Undefined{"the response does not vary"};
  }
  VectorXd centred = VectorXd::Map(response.data(), std::ssize(response));
  centred = (centred.array() - m->origin) - m->offset;
  const Fit fit = fitted(design->columns, centred);
  if (fit.squares <= rounding) {
    return Undefined{"the fit is exact: no residuals are left to judge it by"};
  }
  return summarized(*design, fit, *m, df, level);
}

Defined<Regression> linear_regression(std::span<const double> predictor,
                                      std::span<const double> response, double level) {
  return linear_regression(MatrixXd(VectorXd::Map(predictor.data(), std::ssize(predictor))),
                           response, level);
}

}  // namespace haptrial::analysis
