#include "analysis/mixed_model.h"

#include <cmath>
#include <map>
#include <optional>
#include <stdexcept>

#include "analysis/centered_design.h"
#include "analysis/descriptive.h"
#include "analysis/profile_likelihood.h"
#include "analysis/root.h"

namespace haptrial::analysis {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using Point = ProfileLikelihood::Point;

struct Grouping {
  std::vector<std::size_t> numbers;  // (observations) 0 .. count - 1
  std::size_t count{0};
};

Grouping numbered(std::span<const std::size_t> groups) {
  std::map<std::size_t, std::size_t> numbers;
  Grouping result;
  for (const auto group : groups) {
    result.numbers.push_back(numbers.try_emplace(group, numbers.size()).first->second);
  }
  result.count = numbers.size();
  return result;
}

// The lowest point of the criterion: a search by quarters of a decade, then the root of its slope.
// Nothing where it falls without end.
std::optional<Point> lowest(const ProfileLikelihood& likelihood) {
  constexpr double kFirst = -8.0, kLast = 10.0, kStep = 0.25;  // log10 of rho
  std::vector<double> rho{0.0};
  for (double power = kFirst; power <= kLast; power += kStep) {
    rho.push_back(std::pow(10.0, power));
  }
  std::size_t best = 0;
  double least = likelihood.at(0.0).criterion;
  for (std::size_t i = 1; i < rho.size(); ++i) {
    if (const double here = likelihood.at(rho[i]).criterion; here < least) {
      least = here;
      best = i;
    }
  }
  const auto slope = [&](double r) { return likelihood.at(r).slope; };
  if (best == 0 && slope(0.0) >= 0.0) {
    return likelihood.at(0.0);
  }
  const bool rising = best > 0 && slope(rho[best]) > 0.0;
  if (!rising && best + 1 == rho.size()) {
    return std::nullopt;
  }
  const double low = rising ? rho[best - 1] : rho[best];
  const double high = rising ? rho[best] : rho[best + 1];
  if (!(slope(low) < 0.0 && slope(high) > 0.0)) {
    return std::nullopt;
  }
  return likelihood.at(find_root(slope, low, high));
}

// Satterthwaite: 2 v² / Var(v) of the variance v of a coefficient, which depends on the estimates
// of (within, rho); their covariance is twice the inverse Hessian of the criterion.
class Satterthwaite {
 public:
  Satterthwaite(const Point& point, double df) : point_(point), df_(df) {
    const double s = point.within;
    MatrixXd m = -point.leverage * point.leverage.transpose();  // Z' P Z
    m.diagonal() += point.weights;
    h11_ = df / (s * s);
    h12_ = point.effects.squaredNorm() / (s * s);
    h22_ = 2.0 * point.effects.dot(m * point.effects) / s - m.squaredNorm();
  }

  /// @param contrast  of the coefficients.
  double df(const VectorXd& contrast) const {
    if (point_.rho == 0.0) {
      return df_;
    }
    const VectorXd c = point_.root.transpose() * contrast;
    const double v = point_.within * c.squaredNorm();
    const double g1 = c.squaredNorm();
    const double g2 = point_.within * (point_.leverage * c).squaredNorm();
    const double determinant = h11_ * h22_ - h12_ * h12_;
    const double quadratic = g1 * g1 * h22_ - 2.0 * g1 * g2 * h12_ + g2 * g2 * h11_;
    return v * v * determinant / quadratic;
  }

 private:
  const Point& point_;
  double df_;
  double h11_, h12_, h22_;
};

/// Nothing where a coefficient has no degrees of freedom: the variance between groups cannot be
/// told from the predictors then.
std::optional<MixedModel> described(const CenteredDesign& design, const Point& point, double df,
                                    double origin, double level) {
  MixedModel model;
  const MatrixXd back = design.back();
  VectorXd estimates = back * point.coefficients;
  estimates[0] += origin;
  const Satterthwaite satterthwaite(point, df);
  for (Eigen::Index k = 0; k < estimates.size(); ++k) {
    const VectorXd contrast = back.row(k).transpose();
    const double error = std::sqrt(point.within) * (point.root.transpose() * contrast).norm();
    const double freedom = satterthwaite.df(contrast);
    if (!(freedom > 0.0 && std::isfinite(freedom))) {
      return std::nullopt;
    }
    model.coefficients.push_back(coefficient(estimates[k], error, freedom, level));
  }
  model.variance_within = point.within;
  model.variance_between = point.rho * point.within;
  model.at_boundary = point.rho == 0.0;
  // The criterion has the determinant of the scaled columns.
  model.log_likelihood = -0.5 * point.criterion - design.scales.array().log().sum();
  return model;
}

}  // namespace

Defined<MixedModel> random_intercept_model(std::span<const double> response,
                                           const MatrixXd& predictors,
                                           std::span<const std::size_t> groups, double level) {
  if (predictors.rows() != std::ssize(response) || response.size() != groups.size()) {
    throw std::invalid_argument("random_intercept_model: the lengths differ");
  }
  const auto m = moments(response);
  if (!m) {
    return Undefined{m.because()};
  }
  const Grouping grouping = numbered(groups);
  if (grouping.count < 2) {
    return Undefined{"there is only one group"};
  }
  if (grouping.count == groups.size()) {
    return Undefined{"every group has a single value"};
  }
  if (predictors.rows() - predictors.cols() < 2) {
    return Undefined{"there are not more values than coefficients"};
  }
  const auto design = centered_design(predictors);
  if (!design) {
    return Undefined{design.because()};
  }
  VectorXd shifted = VectorXd::Map(response.data(), std::ssize(response));
  shifted = (shifted.array() - m->origin) - m->offset;
  const ProfileLikelihood likelihood(design->columns, shifted, grouping.numbers);
  const char* const exact = "nothing varies within the groups beyond what the predictors explain";
  if (likelihood.within_squares() <= rounding_of(response)) {
    return Undefined{exact};
  }
  const auto point = lowest(likelihood);
  if (!point) {
    return Undefined{exact};
  }
  auto model = described(*design, *point, likelihood.df(), m->mean(), level);
  if (!model) {
    return Undefined{"a coefficient has no degrees of freedom: groups and predictors go together"};
  }
  model->observations = response.size();
  model->groups = grouping.count;
  return *model;
}

}  // namespace haptrial::analysis
