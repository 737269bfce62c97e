#include "analysis/statistics/variance/within_effect.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "analysis/statistics/base/decomposition.h"
#include "analysis/statistics/base/distributions.h"

namespace haptrial::analysis {
namespace {

double mauchly_p(double log_w, double c, double df) {
  const double rho = 1.0 - (2.0 * c * c + c + 2.0) / (6.0 * c * df);
  const double scale = df * c * rho;
  const double second = (c + 2.0) * (c - 1.0) * (c - 2.0) *
                        (2.0 * c * c * c + 6.0 * c * c + 3.0 * c + 2.0) / (288.0 * scale * scale);
  const double statistic = -df * rho * log_w;
  const double freedom = c * (c + 1.0) / 2.0 - 1.0;
  const double p = chi_squared_upper_tail(statistic, freedom);
  return std::clamp(p + second * (chi_squared_upper_tail(statistic, freedom + 4.0) - p), 0.0, 1.0);
}

Defined<Mauchly> mauchly(const Eigen::MatrixXd& products, double df) {
  const auto c = static_cast<double>(products.rows());
  if (products.rows() < 2) {
    return Undefined{"two conditions have a single difference"};
  }
  if (df < c) {
    return Undefined{"too few participants for this number of conditions"};
  }
  const Eigen::VectorXd variances = symmetric_eigen(products).values;
  const double rounding = c * std::numeric_limits<double>::epsilon() * variances.maxCoeff();
  if (variances.minCoeff() <= rounding) {
    return Undefined{"a difference between conditions does not vary or follows from the others"};
  }
  const double log_w =
      std::min(0.0, variances.array().log().sum() - c * std::log(variances.mean()));
  return Mauchly{std::exp(log_w), mauchly_p(log_w, c, df)};
}

Defined<double> huynh_feldt(double greenhouse_geisser, double c, double df) {
  const double spread = c * greenhouse_geisser;
  if (df - spread <= 1e-9 * df) {
    return Undefined{"there are too few participants"};
  }
  return ((df + 1.0) * spread - 2.0) / (c * (df - spread));
}

}  // namespace

Sphericity sphericity(const Eigen::MatrixXd& products, double df) {
  const auto c = static_cast<double>(products.rows());
  const Eigen::MatrixXd unit = products / products.trace();
  Sphericity result;
  result.mauchly = mauchly(unit, df);
  result.greenhouse_geisser = std::clamp(1.0 / (c * unit.squaredNorm()), 1.0 / c, 1.0);
  result.huynh_feldt = huynh_feldt(result.greenhouse_geisser, c, df);
  return result;
}

}  // namespace haptrial::analysis

namespace haptrial::analysis::within {

// Helmert's contrasts: each level against the ones before it.
Eigen::MatrixXd contrasts(std::size_t levels) {
  const auto k = static_cast<Eigen::Index>(levels);
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(k, k - 1);
  for (Eigen::Index j = 1; j < k; ++j) {
    const auto before = static_cast<double>(j);
    const double length = std::sqrt(before * (before + 1.0));
    result.col(j - 1).head(j).setConstant(1.0 / length);
    result(j, j - 1) = -before / length;
  }
  return result;
}

Eigen::MatrixXd constant(std::size_t levels) {
  const auto k = static_cast<Eigen::Index>(levels);
  return Eigen::MatrixXd::Constant(k, 1, 1.0 / std::sqrt(static_cast<double>(levels)));
}

Eigen::MatrixXd product(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  Eigen::MatrixXd result(a.rows() * b.rows(), a.cols() * b.cols());
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    for (Eigen::Index j = 0; j < a.cols(); ++j) {
      result.block(i * b.rows(), j * b.cols(), b.rows(), b.cols()) = a(i, j) * b;
    }
  }
  return result;
}

Eigen::MatrixXd scores(const Table& table, const Eigen::MatrixXd& contrasts) {
  Eigen::MatrixXd shifted(static_cast<Eigen::Index>(table.size()), contrasts.rows());
  for (Eigen::Index i = 0; i < shifted.rows(); ++i) {
    const auto& row = table[static_cast<std::size_t>(i)];
    for (Eigen::Index j = 0; j < shifted.cols(); ++j) {
      shifted(i, j) = row[static_cast<std::size_t>(j)] - row.front();
    }
  }
  return shifted * contrasts;
}

Eigen::MatrixXd products(const Eigen::MatrixXd& scores) {
  const Eigen::MatrixXd deviations = scores.rowwise() - scores.colwise().mean();
  return deviations.transpose() * deviations;
}

Defined<WithinEffect> tested(double squares, double df, const Eigen::MatrixXd& products,
                             double df_rows, double rounding) {
  WithinEffect result;
  result.df = df;
  result.df_error = df_rows * static_cast<double>(products.rows());
  result.squares = squares;
  result.squares_error = products.trace();
  if (result.squares_error <= rounding) {
    return Undefined{"the conditions differ by the same amount for every participant"};
  }
  result.f = (result.squares / result.df) / (result.squares_error / result.df_error);
  if (!std::isfinite(result.f)) {
    return Undefined{kBeyondDouble};
  }
  result.p = f_upper_tail(result.f, result.df, result.df_error);
  result.partial_eta_squared = result.squares / (result.squares + result.squares_error);
  result.sphericity = sphericity(products, df_rows);
  const auto corrected = [&](double epsilon) {
    return f_upper_tail(result.f, epsilon * result.df, epsilon * result.df_error);
  };
  result.p_greenhouse_geisser = corrected(result.sphericity.greenhouse_geisser);
  const auto& factor = result.sphericity.huynh_feldt;
  result.p_huynh_feldt =
      factor ? Defined<double>(corrected(std::min(1.0, *factor))) : Undefined{factor.because()};
  return result;
}

double rounding_squares(const Table& table) {
  double largest = 0.0;
  double count = 0.0;
  for (const auto& row : table) {
    for (const double v : row) {
      largest = std::max(largest, std::abs(v));
      count += 1.0;
    }
  }
  const double unit = 8.0 * std::numeric_limits<double>::epsilon() * largest;
  return count * unit * unit;
}

std::string problem(const Table& table) {
  if (table.size() < 2) {
    return "fewer than two participants have a mean in every condition";
  }
  if (table.front().size() < 2) {
    return "there are fewer than two conditions";
  }
  for (const auto& row : table) {
    if (row.size() != table.front().size()) {
      return "a participant lacks a condition";
    }
    if (!std::all_of(row.begin(), row.end(), [](double v) { return std::isfinite(v); })) {
      return "a value is not a finite number";
    }
  }
  return {};
}

}  // namespace haptrial::analysis::within
