#include "analysis/psychometric/models/laplace.h"

#include <cmath>

#include "analysis/psychometric/models/binomial_link.h"
#include "analysis/statistics/base/decomposition.h"

namespace haptrial::analysis {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

std::optional<LaplaceMode> laplace_mode(const BinomialGroup& group, BinomialLink link,
                                        const VectorXd& beta, const MatrixXd& lower) {
  constexpr int kMost = 100, kHalvings = 40;
  const MatrixXd z = group.random * lower;
  const VectorXd around = group.fixed * beta;
  LaplaceMode mode;
  mode.u = VectorXd::Zero(lower.cols());
  BinomialRows rows = binomial_rows(group.data, link, around);
  double value = rows.log_likelihood;
  for (int step = 0; step < kMost && std::isfinite(value); ++step) {
    const VectorXd slope = z.transpose() * rows.slope - mode.u;
    const MatrixXd information = z.transpose() * rows.weight.asDiagonal() * z +
                                 MatrixXd::Identity(lower.cols(), lower.cols());
    const auto factor = cholesky(information);
    if (!factor) {
      return std::nullopt;
    }
    const VectorXd half = solve_lower(*factor, slope);
    if (half.squaredNorm() < 1e-26 * (1.0 + std::abs(value))) {
      mode.log_likelihood = value - factor->diagonal().array().log().sum();
      mode.weight = rows.weight;
      mode.factor = *factor;
      return mode;
    }
    const VectorXd change =
        solve_lower(factor->transpose().rowwise().reverse().colwise().reverse(), half.reverse())
            .reverse();
    double part = 1.0;
    bool moved = false;
    for (int i = 0; i < kHalvings && !moved; ++i, part *= 0.5) {
      const VectorXd next = mode.u + part * change;
      const BinomialRows there = binomial_rows(group.data, link, around + z * next);
      const double found = there.log_likelihood - 0.5 * next.squaredNorm();
      moved = found >= value - 1e-13 * std::abs(value);
      if (moved) {
        mode.u = next;
        rows = there;
        value = found;
      }
    }
    if (!moved) {
      return std::nullopt;
    }
  }
  return std::nullopt;
}

MatrixXd lower_triangle(const VectorXd& elements, Index size) {
  MatrixXd lower = MatrixXd::Zero(size, size);
  Index k = 0;
  for (Index column = 0; column < size; ++column) {
    for (Index row = column; row < size; ++row) {
      lower(row, column) = elements[k++];
    }
  }
  return lower;
}

}  // namespace haptrial::analysis
