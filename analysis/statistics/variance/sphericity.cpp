#include "analysis/statistics/variance/sphericity.h"

#include <algorithm>
#include <cmath>
#include <limits>

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
