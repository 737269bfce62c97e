#include "analysis/device/least_squares.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace haptrial::analysis {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kStep = 1e-4;  // of a derivative, in scales
constexpr int kMostSteps = 60;
constexpr double kLeastGain = 1e-9;  // of a step that is worth another, as a share of the sum

MatrixXd slopes(const VectorXd& at, const VectorXd& scale, long count, const Residuals& residuals) {
  MatrixXd slope(count, at.size());
  VectorXd above(count), below(count);
  for (int i = 0; i < at.size(); ++i) {
    VectorXd moved = at;
    moved[i] = at[i] + kStep * scale[i];
    residuals(moved, above);
    moved[i] = at[i] - kStep * scale[i];
    residuals(moved, below);
    slope.col(i) = (above - below) / (2.0 * kStep * scale[i]);
  }
  return slope;
}

/// 1 + 2 (r1 + r2 + …) up to the first correlation that is no longer clearly above 0.
double correlation_time(const VectorXd& r) {
  const double power = r.squaredNorm();
  const double noise = 2.0 / std::sqrt(static_cast<double>(r.size()));
  double time = 1.0;
  for (long lag = 1; lag < r.size() / 4 && power > 0.0; ++lag) {
    const double c = r.head(r.size() - lag).dot(r.tail(r.size() - lag)) / power;
    if (c < noise) {
      break;
    }
    time += 2.0 * c;
  }
  return time;
}

}  // namespace

Interval FittedParameters::interval(int parameter) const {
  return interval_of(value[parameter], std::sqrt(covariance(parameter, parameter)), df);
}

Interval FittedParameters::interval(const std::function<double(const VectorXd&)>& function,
                                    const VectorXd& scale) const {
  VectorXd slope(value.size());
  for (int i = 0; i < value.size(); ++i) {
    VectorXd moved = value;
    moved[i] = value[i] + kStep * scale[i];
    const double above = function(moved);
    moved[i] = value[i] - kStep * scale[i];
    slope[i] = (above - function(moved)) / (2.0 * kStep * scale[i]);
  }
  return interval_of(function(value), std::sqrt(slope.dot(covariance * slope)), df);
}

FittedParameters fit_least_squares(const VectorXd& start, const VectorXd& scale, long count,
                                   const Residuals& residuals, bool ordered_in_time) {
  VectorXd at = start;
  VectorXd r(count), tried(count);
  residuals(at, r);
  double damping = 1e-6;
  MatrixXd normal;
  for (int step = 0; step < kMostSteps; ++step) {
    const MatrixXd slope = slopes(at, scale, count, residuals) * scale.asDiagonal();
    normal = slope.transpose() * slope;
    const VectorXd gradient = slope.transpose() * r;
    bool moved = false;
    double change = 0.0;
    const double before = r.squaredNorm();
    for (; damping < 1e12 && !moved; damping *= 10.0) {
      MatrixXd damped = normal;
      damped.diagonal() *= 1.0 + damping;
      damped.diagonal().array() += 1e-300;
      const VectorXd by = -damped.ldlt().solve(gradient);
      if (!by.allFinite()) {
        continue;
      }
      const VectorXd next = at + scale.cwiseProduct(by);
      residuals(next, tried);
      if (tried.allFinite() && tried.squaredNorm() <= r.squaredNorm()) {
        change = by.cwiseAbs().maxCoeff();
        at = next;
        r = tried;
        moved = true;
        damping = std::max(1e-9, 0.01 * damping);
      }
    }
    if (!moved || change < 1e-9 || r.squaredNorm() > (1.0 - kLeastGain) * before) {
      break;
    }
  }
  FittedParameters fit;
  fit.value = at;
  fit.df = static_cast<double>(count - at.size());
  fit.chi_squared = r.squaredNorm();
  const MatrixXd slope = slopes(at, scale, count, residuals) * scale.asDiagonal();
  normal = slope.transpose() * slope;
  const double stretch = ordered_in_time ? correlation_time(r) : 1.0;
  fit.covariance = normal.ldlt().solve(MatrixXd::Identity(at.size(), at.size()));
  fit.covariance = (stretch * fit.chi_squared / fit.df * scale.asDiagonal() * fit.covariance *
                    scale.asDiagonal())
                       .eval();
  fit.df /= stretch;
  return fit;
}

}  // namespace haptrial::analysis
