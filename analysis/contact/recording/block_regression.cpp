#include "analysis/contact/recording/block_regression.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "analysis/statistics/base/decomposition.h"
#include "analysis/statistics/base/distributions.h"

namespace haptrial::evaluation {
namespace {

constexpr double kNotFixed = 1e-10;  // of the largest eigenvalue
constexpr double kAlike = 0.95;      // correlation of two estimates

struct Sums {
  Eigen::MatrixXd xx;
  Eigen::VectorXd xy;
};

/// Solves xx c = xy in the directions that are fixed.
Eigen::VectorXd solve_fixed(const Sums& sums) {
  const analysis::SymmetricEigen eigen = analysis::symmetric_eigen(sums.xx);
  Eigen::VectorXd along = eigen.vectors.transpose() * sums.xy;
  const double least = kNotFixed * eigen.values.maxCoeff();
  for (Eigen::Index i = 0; i < along.size(); ++i) {
    const double eigenvalue = eigen.values[i];
    along[i] = eigenvalue > least ? along[i] / eigenvalue : 0.0;
  }
  return eigen.vectors * along;
}

void check_regression(const Eigen::MatrixXd& x, const Eigen::VectorXd& y,
                      const std::vector<std::string>& names, const BlockOptions& options) {
  if (x.rows() != y.size() || x.cols() != static_cast<Eigen::Index>(names.size()) || x.cols() < 1) {
    throw std::invalid_argument("x, y and names must fit each other");
  }
  if (options.blocks < 2 || options.blocks > x.rows() || x.rows() < x.cols()) {
    throw std::invalid_argument(
        "blocks must be 2 to the number of rows, which must not be fewer "
        "than the coefficients");
  }
  if (!(options.level > 0.0 && options.level < 1.0)) {
    throw std::invalid_argument("level of an interval must lie inside (0, 1)");
  }
  if (!x.allFinite() || !y.allFinite()) {
    throw std::invalid_argument("x and y must be finite");
  }
}

/// Names the coefficients that lie along directions that are not fixed. @returns which they are
std::vector<bool> name_not_fixed(const Eigen::MatrixXd& xx, const std::vector<std::string>& names,
                                 std::vector<std::string>& sentences) {
  const analysis::SymmetricEigen eigen = analysis::symmetric_eigen(xx);
  std::vector<bool> not_fixed(names.size(), false);
  for (Eigen::Index d = 0; d < xx.cols(); ++d) {
    if (eigen.values[d] > kNotFixed * eigen.values.maxCoeff()) {
      continue;
    }
    std::string list;
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (std::abs(eigen.vectors(static_cast<Eigen::Index>(i), d)) > 1e-3) {
        not_fixed[i] = true;
        list += (list.empty() ? "" : ", ") + names[i];
      }
    }
    sentences.push_back(list.find(',') == std::string::npos
                            ? fmt::format("The data say nothing about {}.", list)
                            : fmt::format("The data fix only a combination of {}.", list));
  }
  return not_fixed;
}

void name_alike(const BlockFit& fit, const std::vector<bool>& not_fixed,
                const std::vector<std::string>& names, std::vector<std::string>& sentences) {
  for (std::size_t i = 0; i < names.size(); ++i) {
    for (std::size_t j = i + 1; j < names.size(); ++j) {
      const auto a = static_cast<Eigen::Index>(i), b = static_cast<Eigen::Index>(j);
      const double scale = std::sqrt(fit.covariance(a, a) * fit.covariance(b, b));
      const double correlation = scale > 0.0 ? fit.covariance(a, b) / scale : 0.0;
      if (!not_fixed[i] && !not_fixed[j] && std::abs(correlation) > kAlike) {
        sentences.push_back(
            fmt::format("{} and {} can hardly be told apart: their estimates correlate by {:.3f}.",
                        names[i], names[j], correlation));
      }
    }
  }
}

}  // namespace

BlockFit fit_blocks(const Eigen::MatrixXd& x, const Eigen::VectorXd& y,
                    const std::vector<std::string>& names, const BlockOptions& options) {
  check_regression(x, y, names, options);
  Eigen::VectorXd scale = x.colwise().norm().transpose();
  scale = (scale.array() > 0.0).select(scale, 1.0);
  const Eigen::MatrixXd scaled = x * scale.cwiseInverse().asDiagonal();
  const Sums all{scaled.transpose() * scaled, scaled.transpose() * y};
  const Eigen::VectorXd coefficients = solve_fixed(all);

  Eigen::MatrixXd left_out(x.cols(), options.blocks);
  for (int b = 0; b < options.blocks; ++b) {
    const Eigen::Index begin = x.rows() * b / options.blocks;
    const Eigen::Index count = x.rows() * (b + 1) / options.blocks - begin;
    const auto rows = scaled.middleRows(begin, count);
    left_out.col(b) = solve_fixed(
        {all.xx - rows.transpose() * rows, all.xy - rows.transpose() * y.segment(begin, count)});
  }
  const double blocks = options.blocks;
  const Eigen::MatrixXd deviation = left_out.colwise() - left_out.rowwise().mean();
  BlockFit fit;
  const Eigen::MatrixXd to_unit = scale.cwiseInverse().asDiagonal();
  fit.coefficients = to_unit * coefficients;
  fit.covariance = (blocks - 1.0) / blocks * to_unit * deviation * deviation.transpose() * to_unit;
  fit.residual_rms =
      std::sqrt((y - scaled * coefficients).squaredNorm() / static_cast<double>(y.size()));
  const std::vector<bool> not_fixed = name_not_fixed(all.xx, names, fit.confounded);
  if (fit.residual_rms > 1e-12 * std::sqrt(y.squaredNorm() / static_cast<double>(y.size()))) {
    name_alike(fit, not_fixed, names, fit.confounded);  // not of rounding errors
  }
  const double t = analysis::t_quantile(0.5 + 0.5 * options.level, blocks - 1.0);
  for (Eigen::Index i = 0; i < x.cols(); ++i) {
    const double half = not_fixed[static_cast<std::size_t>(i)]
                            ? std::numeric_limits<double>::infinity()
                            : t * std::sqrt(fit.covariance(i, i));
    const double value = fit.coefficients[i];
    fit.intervals.push_back({value, value - half, value + half});
  }
  return fit;
}

}  // namespace haptrial::evaluation
