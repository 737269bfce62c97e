#include "analysis/reaching/force_compensation.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "analysis/statistics/base/descriptive.h"

namespace haptrial::analysis {
namespace {

/// Variance of the sum of correlated scores (n x 2), by Newey and West's weights.
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

/// The same where each score follows from the one before, up to what is new in it: the weights are
/// laid on what is new, and the memory of the scores is put back (Andrews and Monahan 1992).
Eigen::Matrix2d whitened_long_run(const Eigen::MatrixX2d& scores, std::size_t lags) {
  constexpr double kMostKept = 0.97;
  const Eigen::Index n = scores.rows();
  if (lags == 0) {
    return long_run(scores, 0);
  }
  const auto before = scores.topRows(n - 1);
  const auto after = scores.bottomRows(n - 1);
  // Each column on its own: no eigenvalue of a fitted matrix can come too close to 1.
  Eigen::Array2d keep;
  for (Eigen::Index k = 0; k < 2; ++k) {
    const double squares = before.col(k).squaredNorm();
    keep[k] = squares > 0.0 ? before.col(k).dot(after.col(k)) / squares : 0.0;
  }
  keep = keep.max(-kMostKept).min(kMostKept);
  Eigen::MatrixX2d fresh = after - before * keep.matrix().asDiagonal();
  const Eigen::Vector2d back = (1.0 / (1.0 - keep)).matrix();
  return back.asDiagonal() * long_run(fresh, lags) * back.asDiagonal();
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
  const Eigen::Matrix2d covariance = small * whitened_long_run(influence, lags);
  result.slope_error = std::sqrt(std::max(0.0, covariance(0, 0)));
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
