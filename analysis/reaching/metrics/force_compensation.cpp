#include "analysis/reaching/metrics/force_compensation.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "analysis/statistics/base/descriptive.h"

namespace haptrial::analysis {
namespace {

/// Errors of slope and mean from the scores of the samples (n x 2), by Newey and West's weights.
Eigen::Matrix2d long_run(const Eigen::MatrixX2d& scores, std::size_t lags) {
  const Eigen::Index n = scores.rows();
  Eigen::Matrix2d sum = scores.transpose() * scores;
  const auto last = std::min(static_cast<Eigen::Index>(lags), n - 1);
  for (Eigen::Index lag = 1; lag <= last; ++lag) {
    const double weight = 1.0 - static_cast<double>(lag) / (static_cast<double>(lags) + 1.0);
    const Eigen::Matrix2d cross = scores.topRows(n - lag).transpose() * scores.bottomRows(n - lag);
    sum += weight * (cross + cross.transpose());
  }
  return sum;
}

}  // namespace

Defined<ForceCompensation> force_compensation(std::span<const double> measured,
                                              std::span<const double> ideal, std::size_t lags) {
  if (measured.size() != ideal.size()) {
    throw std::invalid_argument("measured and ideal must be equally long");
  }
  const auto y = moments(measured), x = moments(ideal);
  if (!x || !y) {
    return Undefined{!x ? x.because() : y.because()};
  }
  if (x->count < 4) {
    return Undefined{"there are fewer than four samples"};
  }
  if (!(x->squares > 0.0) || !(y->squares > 0.0)) {
    return Undefined{"a force does not vary"};
  }
  const auto n = static_cast<Eigen::Index>(x->count);
  const Eigen::ArrayXd u = Eigen::ArrayXd::Map(ideal.data(), n) - x->mean();
  const Eigen::ArrayXd v = Eigen::ArrayXd::Map(measured.data(), n) - y->mean();
  ForceCompensation result;
  result.samples = x->count;
  result.slope = (u * v).sum() / x->squares;
  result.intercept = y->mean() - result.slope * x->mean();
  const Eigen::ArrayXd left = v - result.slope * u;
  result.r_squared = 1.0 - left.square().sum() / y->squares;
  // Influence of each sample on slope and intercept.
  Eigen::MatrixX2d influence(n, 2);
  influence.col(0) = left * u / x->squares;
  influence.col(1) = left / static_cast<double>(n) - x->mean() * influence.col(0).array();
  const double small = static_cast<double>(n) / static_cast<double>(n - 2);
  const Eigen::Matrix2d covariance = small * long_run(influence, lags);
  result.slope_error = std::sqrt(std::max(0.0, covariance(0, 0)));
  result.intercept_error = std::sqrt(std::max(0.0, covariance(1, 1)));
  return result;
}

Defined<ForceCompensation> force_compensation(const Reach& reach, const Eigen::Matrix3d& field,
                                              double from, double to,
                                              const CompensationOptions& options) {
  check_reach(reach);
  if (reach.force.empty()) {
    throw std::invalid_argument("force must be as long as time");
  }
  if (!(options.memory >= 0.0)) {
    throw std::invalid_argument("memory must not be negative");
  }
  const WayFrame frame(reach.start, reach.target, options.normal);
  const double sideways = frame.lateral(field * frame.along());  // per velocity along the way
  std::vector<double> measured, ideal;
  for (std::size_t i = 0; i < reach.time.size(); ++i) {
    if (reach.time[i] >= from && reach.time[i] <= to) {
      measured.push_back(frame.lateral(reach.force[i]));
      ideal.push_back(sideways * frame.along(reach.velocity[i]));
    }
  }
  const double step =
      (reach.time.back() - reach.time.front()) / static_cast<double>(reach.time.size() - 1);
  const double lags =
      std::min(std::round(options.memory / step), static_cast<double>(reach.time.size()));
  return force_compensation(measured, ideal, static_cast<std::size_t>(lags));
}

}  // namespace haptrial::analysis
