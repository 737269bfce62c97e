#include "analysis/profile_likelihood.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace haptrial::analysis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd triangle(const MatrixXd& matrix) {
  const Eigen::HouseholderQR<MatrixXd> qr(matrix);
  const Index rows = std::min(matrix.rows(), matrix.cols());
  return qr.matrixQR().topRows(rows).triangularView<Eigen::Upper>();
}

Index group_of(std::span<const std::size_t> groups, Index row) {
  return static_cast<Index>(groups[static_cast<std::size_t>(row)]);
}

}  // namespace

ProfileLikelihood::ProfileLikelihood(const MatrixXd& columns, const VectorXd& response,
                                     std::span<const std::size_t> groups) {
  const Index n = columns.rows();
  const Index p = columns.cols();
  const auto count = static_cast<Index>(*std::max_element(groups.begin(), groups.end()) + 1);
  MatrixXd values(n, p + 2);
  values << VectorXd::Ones(n), columns, response;
  counts_ = VectorXd::Zero(count);
  means_ = MatrixXd::Zero(count, p + 2);
  for (Index i = 0; i < n; ++i) {
    counts_[group_of(groups, i)] += 1.0;
    means_.row(group_of(groups, i)) += values.row(i);
  }
  means_ = counts_.cwiseInverse().asDiagonal() * means_;
  for (Index i = 0; i < n; ++i) {
    values.row(i) -= means_.row(group_of(groups, i));
  }
  deviations_ = triangle(values.rightCols(p + 1));
  within_squares_ = deviations_.rows() > p ? deviations_(p, p) * deviations_(p, p) : 0.0;
  df_ = static_cast<double>(n - 1 - p);
}

ProfileLikelihood::Point ProfileLikelihood::at(double rho) const {
  const Index q = means_.cols() - 1;  // coefficients
  Point point;
  point.rho = rho;
  point.weights = counts_.array() / (1.0 + counts_.array() * rho);
  MatrixXd stacked = MatrixXd::Zero(deviations_.rows() + means_.rows(), q + 1);
  stacked.topRightCorner(deviations_.rows(), q) = deviations_;
  stacked.bottomRows(means_.rows()) = point.weights.cwiseSqrt().asDiagonal() * means_;
  const MatrixXd r = triangle(stacked);

  point.root = r.topLeftCorner(q, q).triangularView<Eigen::Upper>().solve(MatrixXd::Identity(q, q));
  point.coefficients = point.root * r.col(q).head(q);
  point.squares = r(q, q) * r(q, q);
  point.within = point.squares / df_;
  point.effects =
      point.weights.asDiagonal() * (means_.col(q) - means_.leftCols(q) * point.coefficients);
  point.leverage = point.weights.asDiagonal() * means_.leftCols(q) * point.root;

  const double log_v = (1.0 + counts_.array() * rho).log().sum();
  const double log_x = 2.0 * r.diagonal().head(q).cwiseAbs().array().log().sum();
  point.criterion = df_ * (1.0 + std::log(2.0 * std::numbers::pi * point.within)) + log_v + log_x;
  point.slope = point.weights.sum() - point.leverage.squaredNorm() -
                point.effects.squaredNorm() / point.within;
  return point;
}

}  // namespace haptrial::analysis
