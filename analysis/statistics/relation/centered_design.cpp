#include "analysis/statistics/relation/centered_design.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "analysis/statistics/base/descriptive.h"

namespace haptrial::analysis {

Eigen::MatrixXd CenteredDesign::back() const {
  const Eigen::Index p = means.size();
  Eigen::MatrixXd result = Eigen::MatrixXd::Identity(1 + p, 1 + p);
  for (Eigen::Index j = 0; j < p; ++j) {
    result(0, 1 + j) = -means[j] / scales[j];
    result(1 + j, 1 + j) = 1.0 / scales[j];
  }
  return result;
}

double rounding_of(std::span<const double> values) {
  double largest = 0.0;
  for (const double v : values) {
    largest = std::max(largest, std::abs(v));
  }
  const double unit = 8.0 * std::numeric_limits<double>::epsilon() * largest;
  return static_cast<double>(values.size()) * unit * unit;
}

bool vary_beyond_rounding(std::span<const double> values) {
  const auto m = moments(values);
  return m && m->squares > rounding_of(values);
}

Defined<CenteredDesign> centered_design(const Eigen::MatrixXd& predictors) {
  const Eigen::Index p = predictors.cols();
  CenteredDesign design{predictors, Eigen::VectorXd(p), Eigen::VectorXd(p)};
  double noise = 0.0;  // of the unit columns
  for (Eigen::Index j = 0; j < p; ++j) {
    const std::span<const double> column(predictors.col(j).data(),
                                         static_cast<std::size_t>(predictors.rows()));
    const auto m = moments(column);
    if (!m) {
      return Undefined{m.because()};
    }
    const double rounding = rounding_of(column);
    if (m->squares <= rounding) {
      return Undefined{"predictor " + std::to_string(j + 1) + " does not vary"};
    }
    design.means[j] = m->mean();
    design.scales[j] = std::sqrt(m->squares);
    design.columns.col(j) =
        ((predictors.col(j).array() - m->origin) - m->offset) / design.scales[j];
    noise = std::max(noise, std::sqrt(rounding / m->squares));
  }
  if (p > 0) {
    constexpr double kSmallest = 1e-12;  // distance of a unit column from the span of the others
    const auto qr = design.columns.colPivHouseholderQr();
    const auto diagonal = qr.matrixR().diagonal().cwiseAbs();
    for (Eigen::Index j = 0; j < p; ++j) {
      if (j >= diagonal.size() || diagonal[j] <= std::max(kSmallest, noise)) {
        return Undefined{"predictor " + std::to_string(qr.colsPermutation().indices()[j] + 1) +
                         " is a linear combination of the others"};
      }
    }
  }
  return design;
}

}  // namespace haptrial::analysis
