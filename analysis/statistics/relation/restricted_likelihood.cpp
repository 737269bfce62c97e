#include "analysis/statistics/relation/restricted_likelihood.h"

#include <cmath>
#include <numbers>

#include "analysis/statistics/base/decomposition.h"

namespace haptrial::analysis {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

MatrixXd joined(const MatrixXd& columns, const VectorXd& response) {
  MatrixXd values(columns.rows(), columns.cols() + 2);
  values << VectorXd::Ones(columns.rows()), columns, response;
  return values;
}

/// Z scaled so that Z Z' is the sum of rho_k Z_k Z_k'.
MatrixXd scaled(const RandomBlock& block, const VectorXd& rho) {
  MatrixXd z = block.z;
  for (Index k = 0; k < rho.size(); ++k) {
    const auto begin = block.begins[static_cast<std::size_t>(k)];
    const auto end = block.begins[static_cast<std::size_t>(k) + 1];
    z.middleCols(begin, end - begin) *= std::sqrt(rho[k]);
  }
  return z;
}

}  // namespace

/// A block times V^-1/2.
struct RestrictedLikelihood::Whitened {
  Whitened(const RandomBlock& from, const VectorXd& rho) : block(from) {
    const MatrixXd z = scaled(from, rho);
    MatrixXd v = MatrixXd::Identity(z.rows(), z.rows());
    v.selfadjointView<Eigen::Lower>().rankUpdate(z);
    lower = *cholesky(v);  // no eigenvalue is below 1
    values = solve_lower(lower, from.values);
    log_v = 2.0 * lower.diagonal().array().log().sum();
  }

  const RandomBlock& block;
  MatrixXd lower;   // V = lower lower'
  MatrixXd values;  // (rows x p + 2)
  double log_v{0.0};
};

RestrictedLikelihood::RestrictedLikelihood(const MatrixXd& columns, const VectorXd& response,
                                           const std::vector<Grouping>& terms)
    : data_(random_blocks(joined(columns, response), terms)),
      terms_(std::ssize(terms)),
      rows_(data_.deviations.rows()),
      df_(static_cast<double>(columns.rows() - 1 - columns.cols())) {
  for (const RandomBlock& block : data_.blocks) {
    rows_ += block.values.rows();
  }
}

RestrictedLikelihood::Point RestrictedLikelihood::solved(const VectorXd& rho,
                                                         std::vector<Whitened>* kept) const {
  const Index q = data_.deviations.cols() - 1;  // coefficients
  MatrixXd stacked(rows_, q + 1);
  Index row = data_.deviations.rows();
  stacked.topRows(row) = data_.deviations;
  double log_v = 0.0;
  for (const RandomBlock& block : data_.blocks) {
    Whitened white(block, rho);
    stacked.middleRows(row, white.values.rows()) = white.values;
    row += white.values.rows();
    log_v += white.log_v;
    if (kept != nullptr) {
      kept->push_back(std::move(white));
    }
  }
  const MatrixXd r = triangle(stacked);
  Point point;
  point.rho = rho;
  point.root = r.topLeftCorner(q, q).triangularView<Eigen::Upper>().solve(MatrixXd::Identity(q, q));
  point.coefficients = point.root * r.col(q).head(q);
  point.within = r(q, q) * r(q, q) / df_;
  const double log_x = 2.0 * r.diagonal().head(q).cwiseAbs().array().log().sum();
  point.criterion = df_ * (1.0 + std::log(2.0 * std::numbers::pi * point.within)) + log_v + log_x;
  return point;
}

RestrictedLikelihood::Point RestrictedLikelihood::value(const VectorXd& rho) const {
  return solved(rho, nullptr);
}

namespace {

/// Sums over the blocks of which the derivatives are made, see Slopes.
struct Sums {
  Sums(Index terms, Index q)
      : traces(VectorXd::Zero(terms)),
        effects(VectorXd::Zero(terms)),
        squares(MatrixXd::Zero(terms, terms)),
        forms(MatrixXd::Zero(terms, terms)),
        leaning(MatrixXd::Zero(q, terms)),
        leverage(static_cast<std::size_t>(terms), MatrixXd::Zero(q, q)) {}

  /// @param z         V^-1/2 Z.
  /// @param x         V^-1/2 X root.
  /// @param residual  V^-1/2 (response - X coefficients).
  void add(const RandomBlock& block, const MatrixXd& z, const MatrixXd& x,
           const VectorXd& residual) {
    const MatrixXd g = z.transpose() * z;
    const MatrixXd l = z.transpose() * x;
    const VectorXd u = z.transpose() * residual;
    const auto begin = [&](Index k) { return block.begins[static_cast<std::size_t>(k)]; };
    const auto size = [&](Index k) { return begin(k + 1) - begin(k); };
    for (Index k = 0; k < traces.size(); ++k) {
      const auto lk = l.middleRows(begin(k), size(k));
      const auto uk = u.segment(begin(k), size(k));
      traces[k] += g.diagonal().segment(begin(k), size(k)).sum();
      effects[k] += uk.squaredNorm();
      leverage[static_cast<std::size_t>(k)] += lk.transpose() * lk;
      leaning.col(k) += lk.transpose() * uk;
      for (Index m = 0; m <= k; ++m) {
        const auto gkm = g.block(begin(k), begin(m), size(k), size(m));
        const auto lm = l.middleRows(begin(m), size(m));
        squares(k, m) += gkm.squaredNorm() - 2.0 * lk.cwiseProduct(gkm * lm).sum();
        forms(k, m) += uk.dot(gkm * u.segment(begin(m), size(m)));
      }
    }
  }

  VectorXd traces;                 // of Z_k'V^-1 Z_k
  VectorXd effects;                // |u_k|^2
  MatrixXd squares;                // |Z_k'P Z_m|^2 but for the part of two leverages
  MatrixXd forms;                  // u_k'Z_k'V^-1 Z_m u_m
  MatrixXd leaning;                // (q x terms) root'X'V^-1 Z_k u_k
  std::vector<MatrixXd> leverage;  // see Slopes
};

}  // namespace

RestrictedLikelihood::Slopes RestrictedLikelihood::at(const VectorXd& rho) const {
  std::vector<Whitened> blocks;
  Slopes s;
  static_cast<Point&>(s) = solved(rho, &blocks);
  const Index q = s.coefficients.size();
  Sums sums(terms_, q);
  for (const Whitened& white : blocks) {
    const MatrixXd z = solve_lower(white.lower, white.block.z);
    sums.add(white.block, z, white.values.leftCols(q) * s.root,
             white.values.col(q) - white.values.leftCols(q) * s.coefficients);
  }
  s.effects = sums.effects;
  s.leverage = std::move(sums.leverage);
  s.slope = VectorXd::Zero(terms_);
  VectorXd traces = sums.traces;  // of Z_k'P Z_k
  for (Index k = 0; k < terms_; ++k) {
    traces[k] -= s.leverage[static_cast<std::size_t>(k)].trace();
    s.slope[k] = traces[k] - s.effects[k] / s.within;
  }
  s.hessian = MatrixXd::Zero(terms_, terms_);
  s.expected = MatrixXd::Zero(terms_, terms_);
  for (Index k = 0; k < terms_; ++k) {
    for (Index m = 0; m <= k; ++m) {
      const double squares =
          sums.squares(k, m) + s.leverage[static_cast<std::size_t>(k)]
                                   .cwiseProduct(s.leverage[static_cast<std::size_t>(m)])
                                   .sum();
      const double form = sums.forms(k, m) - sums.leaning.col(k).dot(sums.leaning.col(m));
      s.hessian(k, m) = s.hessian(m, k) = 2.0 * form / s.within - squares -
                                          s.effects[k] * s.effects[m] / (df_ * s.within * s.within);
      s.expected(k, m) = s.expected(m, k) = squares - traces[k] * traces[m] / df_;
    }
  }
  return s;
}

double RestrictedLikelihood::within_squares() const {
  const Index q = data_.deviations.cols() - 1;
  MatrixXd rest(rows_, q + 1);
  rest.setZero();
  Index row = data_.deviations.rows();
  rest.topRows(row) = data_.deviations;
  for (const RandomBlock& block : data_.blocks) {
    if (block.z.cols() == 0) {
      rest.middleRows(row, block.values.rows()) = block.values;
      row += block.values.rows();
      continue;
    }
    const MatrixXd free = beyond_span(block.z, block.values);
    rest.middleRows(row, free.rows()) = free;
    row += free.rows();
  }
  std::vector<Index> varying;  // columns of X that the groups do not explain
  for (Index j = 0; j < q; ++j) {
    constexpr double kRounding = 1e-10;  // of a column of unit length
    if (rest.col(j).norm() > kRounding) {
      varying.push_back(j);
    }
  }
  if (varying.empty()) {
    return rest.col(q).squaredNorm();
  }
  return beyond_span(rest(Eigen::all, varying), rest.col(q)).squaredNorm();
}

}  // namespace haptrial::analysis
