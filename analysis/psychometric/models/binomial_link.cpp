#include "analysis/psychometric/models/binomial_link.h"

#include <gsl/gsl_sf_gamma.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/psychometric/function/sigmoid.h"

namespace haptrial::analysis {

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

}  // namespace haptrial::analysis
