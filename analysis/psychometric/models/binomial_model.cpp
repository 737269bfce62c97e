#include "analysis/psychometric/models/binomial_model.h"

#include <gsl/gsl_sf_gamma.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "analysis/statistics/base/decomposition.h"
#include "analysis/statistics/base/distributions.h"
#include "core/psychometric/function/sigmoid.h"

namespace haptrial::analysis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Coefficients of scaled columns; nothing where the likelihood rises without end.
std::optional<VectorXd> scored(const BinomialData& data, BinomialLink link,
                               const MatrixXd& columns) {
  constexpr int kMost = 100, kHalvings = 40;
  constexpr double kEndless = 1e-7;  // information of a row, of that at 1/2
  VectorXd beta = VectorXd::Zero(columns.cols());
  BinomialRows rows = binomial_rows(data, link, columns * beta);
  for (int step = 0; step < kMost; ++step) {
    const VectorXd slope = columns.transpose() * rows.slope;
    const auto change =
        solve_positive(columns.transpose() * rows.weight.asDiagonal() * columns, slope);
    if (!change) {
      return std::nullopt;
    }
    const double promise = 0.5 * change->col(0).dot(slope);
    double part = 1.0;
    bool moved = false;
    for (int i = 0; i < kHalvings && !moved; ++i, part *= 0.5) {
      const VectorXd next = beta + part * change->col(0);
      const BinomialRows there = binomial_rows(data, link, columns * next);
      moved = there.log_likelihood >= rows.log_likelihood - 1e-13 * std::abs(rows.log_likelihood);
      if (moved) {
        beta = next;
        rows = there;
      }
    }
    // Separated answers end at shares of 0 and 1 everywhere.
    double heaviest = 0.0;
    for (Index i = 0; i < rows.weight.size(); ++i) {
      heaviest = std::max(heaviest, rows.weight[i] / data.trials[static_cast<std::size_t>(i)]);
    }
    if (heaviest < kEndless) {
      return std::nullopt;
    }
    if (promise < 1e-22 * (1.0 + std::abs(rows.log_likelihood)) || !moved) {
      return promise < 1e-10 ? std::optional(beta) : std::nullopt;
    }
  }
  // Fisher's scoring converges linearly with the probit link; a likelihood without a maximum
  // leaves a slope.
  const VectorXd slope = columns.transpose() * rows.slope;
  return slope.cwiseAbs().maxCoeff() < 1e-8 ? std::optional(beta) : std::nullopt;
}

}  // namespace

double log_likelihood_of_shares(const BinomialData& data) {
  double sum = 0.0;
  for (std::size_t i = 0; i < data.yes.size(); ++i) {
    const double yes = data.yes[i], trials = data.trials[i];
    sum += (yes > 0.0 ? yes * std::log(yes / trials) : 0.0) +
           (trials > yes ? (trials - yes) * std::log((trials - yes) / trials) : 0.0);
  }
  return sum;
}

void add_normal_tests(BinomialModel& model, const VectorXd& estimates) {
  const double wide = normal_quantile(0.5 + 0.5 * model.level);
  model.coefficients.clear();
  for (Index k = 0; k < estimates.size(); ++k) {
    BinomialCoefficient c{.estimate = estimates[k], .error = std::sqrt(model.covariance(k, k))};
    c.z = c.estimate / c.error;
    c.p = std::min(1.0, 2.0 * normal_upper_tail(std::abs(c.z)));
    c.low = c.estimate - wide * c.error;
    c.high = c.estimate + wide * c.error;
    model.coefficients.push_back(c);
  }
}

Defined<BinomialModel> binomial_regression(const BinomialData& data, BinomialLink link,
                                           double level) {
  if (!(level > 0.0 && level < 1.0)) {
    throw std::invalid_argument("level of an interval must lie inside (0, 1)");
  }
  const MatrixXd raw = checked_columns(data);
  if (!raw.allFinite()) {
    return Undefined{"a predictor is not finite"};
  }
  if (raw.rows() < raw.cols()) {
    return Undefined{"there are fewer rows than coefficients"};
  }
  const VectorXd scale = raw.colwise().norm().transpose() / std::sqrt(double(raw.rows()));
  if (!(scale.minCoeff() > 0.0)) {
    return Undefined{"a predictor is 0 throughout"};
  }
  const MatrixXd columns = raw * scale.cwiseInverse().asDiagonal();
  const MatrixXd gram = columns.transpose() * columns / double(raw.rows());
  if (!(symmetric_eigen(gram).values[0] > 1e-13)) {
    return Undefined{"a predictor follows from others or does not vary"};
  }
  const auto beta = scored(data, link, columns);
  if (!beta) {
    return Undefined{"the predictors separate \"yes\" from \"no\", so that there is no estimate"};
  }
  const BinomialRows rows = binomial_rows(data, link, columns * *beta);
  const auto inverse = solve_positive(columns.transpose() * rows.weight.asDiagonal() * columns,
                                      MatrixXd::Identity(columns.cols(), columns.cols()));
  if (!inverse) {
    return Undefined{"the coefficients have no covariance"};
  }
  BinomialModel model;
  model.level = level;
  model.observations = data.yes.size();
  model.covariance =
      scale.cwiseInverse().asDiagonal() * *inverse * scale.cwiseInverse().asDiagonal();
  model.log_likelihood = rows.log_likelihood + log_binomials(data);
  model.deviance = 2.0 * (log_likelihood_of_shares(data) - rows.log_likelihood);
  add_normal_tests(model, beta->cwiseQuotient(scale));
  return model;
}

Defined<EqualityPoint> equality_point(const BinomialModel& model, BinomialLink link,
                                      const VectorXd& intercept, const VectorXd& slope) {
  const Index count = std::ssize(model.coefficients);
  if (intercept.size() != count || slope.size() != count) {
    throw std::invalid_argument("intercept and slope must have a weight for each coefficient");
  }
  VectorXd beta(count);
  for (Index k = 0; k < count; ++k) {
    beta[k] = model.coefficients[static_cast<std::size_t>(k)].estimate;
  }
  const double a = intercept.dot(beta), b = slope.dot(beta);
  if (b == 0.0) {
    return Undefined{"the slope is 0"};
  }
  const double quarter = link == BinomialLink::kProbit ? normal_quantile(0.75) : std::log(3.0);
  const double wide = normal_quantile(0.5 + 0.5 * model.level);
  const auto error = [&](const VectorXd& by) { return std::sqrt(by.dot(model.covariance * by)); };
  EqualityPoint e;
  e.point = -a / b;
  e.point_error = error(-intercept / b + slope * (a / (b * b)));
  e.jnd = quarter / std::abs(b);
  e.jnd_error = error(slope * (quarter / (b * b)));
  e.point_low = e.point - wide * e.point_error;
  e.point_high = e.point + wide * e.point_error;
  e.jnd_low = e.jnd - wide * e.jnd_error;
  e.jnd_high = e.jnd + wide * e.jnd_error;
  return e;
}

using Eigen::Index;

BinomialRows binomial_rows(const BinomialData& data, BinomialLink link,
                           const Eigen::VectorXd& eta) {
  const auto sigmoid = link == BinomialLink::kProbit ? psychometric::Sigmoid::kGaussian
                                                     : psychometric::Sigmoid::kLogistic;
  BinomialRows rows{0.0, Eigen::VectorXd::Zero(eta.size()), Eigen::VectorXd::Zero(eta.size())};
  for (Index i = 0; i < eta.size(); ++i) {
    const psychometric::SigmoidPoint s = psychometric::sigmoid_point(sigmoid, eta[i]);
    const double yes = data.yes[static_cast<std::size_t>(i)];
    const double trials = data.trials[static_cast<std::size_t>(i)];
    if ((yes > 0.0 && !(s.share > 0.0)) || (trials > yes && !(s.beyond > 0.0))) {
      rows.log_likelihood = -std::numeric_limits<double>::infinity();
      return rows;
    }
    rows.log_likelihood += (yes > 0.0 ? yes * std::log(s.share) : 0.0) +
                           (trials > yes ? (trials - yes) * std::log(s.beyond) : 0.0);
    if (s.share > 0.0 && s.beyond > 0.0) {
      rows.slope[i] =
          (yes * s.beyond - (trials - yes) * s.share) * s.density / (s.share * s.beyond);
      rows.weight[i] = trials * s.density * s.density / (s.share * s.beyond);
    }
  }
  return rows;
}

double log_binomials(const BinomialData& data) {
  double sum = 0.0;
  for (std::size_t i = 0; i < data.yes.size(); ++i) {
    sum +=
        gsl_sf_lnchoose(static_cast<unsigned>(data.trials[i]), static_cast<unsigned>(data.yes[i]));
  }
  return sum;
}

Eigen::MatrixXd checked_columns(const BinomialData& data) {
  const Index rows = std::ssize(data.yes);
  if (std::ssize(data.trials) != rows || data.predictors.rows() != rows) {
    throw std::invalid_argument("yes, trials and predictors must have as many rows");
  }
  for (std::size_t i = 0; i < data.yes.size(); ++i) {
    if (data.trials[i] < 1 || data.yes[i] < 0 || data.yes[i] > data.trials[i]) {
      throw std::invalid_argument("yes of a row must lie in 0 .. trials, and trials above 0");
    }
  }
  Eigen::MatrixXd columns(rows, data.predictors.cols() + 1);
  columns << Eigen::VectorXd::Ones(rows), data.predictors;
  return columns;
}

std::optional<ScoringMaximum> fisher_scoring(const ScoredLikelihood& likelihood,
                                             const Eigen::VectorXd& start) {
  constexpr int kMost = 500, kHalvings = 40;
  Eigen::VectorXd p = start;
  auto point = likelihood(p);
  for (int step = 0; point && step < kMost; ++step) {
    const auto change = solve_positive(point->information, point->slope);
    if (!change) {
      return std::nullopt;
    }
    const double promise = 0.5 * change->col(0).dot(point->slope);
    if (promise < 1e-18 * (1.0 + std::abs(point->value))) {
      return ScoringMaximum{p, *point};
    }
    double part = 1.0;
    for (int i = 0; i < kHalvings; ++i, part *= 0.5) {
      const Eigen::VectorXd next = p + part * change->col(0);
      const auto there = likelihood(next);
      if (there && there->value >= point->value - 1e-13 * std::abs(point->value)) {
        p = next;
        point = there;
        break;
      }
    }
    if (p.cwiseAbs().maxCoeff() > 50.0) {
      return std::nullopt;  // it rises without end
    }
  }
  return std::nullopt;
}

}  // namespace haptrial::analysis
