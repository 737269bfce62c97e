#include "analysis/statistics/relation/mixed_model.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "analysis/statistics/base/decomposition.h"
#include "analysis/statistics/base/descriptive.h"
#include "analysis/statistics/relation/centered_design.h"
#include "analysis/statistics/relation/mixed_contrast.h"
#include "analysis/statistics/relation/restricted_likelihood.h"

namespace haptrial::analysis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Slopes = RestrictedLikelihood::Slopes;

constexpr double kFirst = -8.0, kLast = 10.0;  // log10 of a rho

/// One rho after the other, the others held; several lowest places are told apart by this alone.
VectorXd scanned(const RestrictedLikelihood& likelihood) {
  const double step = likelihood.terms() == 1 ? 0.25 : 0.5;
  VectorXd best = VectorXd::Zero(likelihood.terms());
  double least = likelihood.value(best).criterion;
  for (Index k = 0; k < likelihood.terms(); ++k) {
    VectorXd here = best;
    for (double power = kFirst; power <= kLast; power += step) {
      here[k] = std::pow(10.0, power);
      if (const double found = likelihood.value(here).criterion; found < least) {
        least = found;
        best = here;
      }
    }
  }
  return best;
}

/// The rhos that may move: those above 0, and those at 0 along which the criterion falls.
std::vector<Index> free_of(const Slopes& s) {
  std::vector<Index> free;
  for (Index k = 0; k < s.rho.size(); ++k) {
    if (s.rho[k] > 0.0 || s.slope[k] < 0.0) {
      free.push_back(k);
    }
  }
  return free;
}

/// Minus the inverse of the matrix times the slope; nothing if it is not positive definite.
std::optional<VectorXd> descent(const MatrixXd& matrix, const VectorXd& slope) {
  const VectorXd diagonal = matrix.diagonal();
  if (!(diagonal.minCoeff() > 0.0)) {
    return std::nullopt;
  }
  const VectorXd scale = diagonal.cwiseSqrt().cwiseInverse();
  const std::optional<MatrixXd> solved =
      solve_positive(scale.asDiagonal() * matrix * scale.asDiagonal(), scale.cwiseProduct(slope));
  if (!solved) {
    return std::nullopt;
  }
  return VectorXd(-scale.cwiseProduct(solved->col(0)));
}

struct Step {
  VectorXd change;       // (K)
  double expected{0.0};  // fall of the criterion that the slope promises
};

/// Newton's step; Fisher's, which always descends, if the criterion is not convex.
Step step_of(const Slopes& s, bool fisher) {
  Step step{VectorXd::Zero(s.rho.size())};
  const std::vector<Index> free = free_of(s);
  if (free.empty()) {
    return step;
  }
  const VectorXd slope = s.slope(free);
  std::optional<VectorXd> change;
  if (!fisher) {
    change = descent(s.hessian(free, free), slope);
  }
  if (!change) {
    // The diagonal alone counts, so that the step still descends when a rho is stopped at 0.
    const VectorXd information = s.expected(free, free).diagonal();
    change = -slope.cwiseQuotient(information.cwiseMax(std::numeric_limits<double>::min()));
  }
  for (std::size_t i = 0; i < free.size(); ++i) {
    step.change[free[i]] = (*change)[static_cast<Index>(i)];
  }
  step.expected = -slope.dot(*change);
  return step;
}

/// Slopes after a part of the step, if the value there is lower.
std::optional<Slopes> lower(const RestrictedLikelihood& likelihood, const Slopes& s,
                            const Step& step) {
  constexpr int kHalvings = 40;
  double part = 1.0;
  for (int i = 0; i < kHalvings; ++i, part *= 0.5) {
    const VectorXd rho = (s.rho + part * step.change).cwiseMax(0.0);
    if (likelihood.value(rho).criterion < s.criterion) {
      return likelihood.at(rho);
    }
  }
  return std::nullopt;
}

/// The slope along the free rhos, each in units of its own.
double steepness(const Slopes& s) {
  double sum = 0.0;
  for (const Index k : free_of(s)) {
    sum += std::pow(s.slope[k] * std::max(s.rho[k], 1e-12), 2);
  }
  return std::sqrt(sum);
}

/// The criterion tells no more here: its slope is brought to zero.
Slopes polished(const RestrictedLikelihood& likelihood, Slopes s) {
  constexpr int kSteps = 6;
  for (int i = 0; i < kSteps; ++i) {
    const VectorXd rho = (s.rho + step_of(s, false).change).cwiseMax(0.0);
    Slopes next = likelihood.at(rho);
    if (!(steepness(next) < steepness(s))) {
      break;
    }
    s = std::move(next);
  }
  return s;
}

/// The lowest point of the criterion over rho >= 0, to the last digits: a scan of each rho in turn,
/// then Newton's method with the rhos held at 0 that would fall below.
/// Nothing if the criterion falls without end.
std::optional<Slopes> lowest_point(const RestrictedLikelihood& likelihood) {
  constexpr int kSteps = 200;
  constexpr double kSmall = 1e-8;  // of the criterion
  const double limit = std::pow(10.0, kLast);
  Slopes s = likelihood.at(scanned(likelihood));
  for (int i = 0; i < kSteps; ++i) {
    const Step step = step_of(s, false);
    if (step.expected <= kSmall) {
      break;
    }
    auto next = lower(likelihood, s, step);
    if (!next) {
      next = lower(likelihood, s, step_of(s, true));
    }
    if (!next) {
      break;
    }
    s = std::move(*next);
  }
  s = polished(likelihood, std::move(s));
  if (s.rho.size() > 0 && s.rho.maxCoeff() >= limit) {
    return std::nullopt;
  }
  return s;
}

const char* const kExact = "nothing varies within the groups beyond what the predictors explain";

std::string with_term(const std::string& reason, std::size_t term, std::size_t terms) {
  return terms == 1 ? reason : "random term " + std::to_string(term + 1) + ": " + reason;
}

/// Why the variances of the terms, the residual and the predictors cannot be told apart, at
/// whatever values.
std::optional<std::string> confounded(const RestrictedLikelihood& likelihood,
                                      const std::vector<Grouping>& terms) {
  if (terms.empty()) {
    return std::nullopt;
  }
  constexpr double kRounding = 1e-10;
  const MatrixXd information = likelihood.at(VectorXd::Zero(likelihood.terms())).expected;
  for (std::size_t k = 0; k < terms.size(); ++k) {
    VectorXd counts = VectorXd::Zero(static_cast<Index>(terms[k].count));
    for (const std::size_t group : terms[k].numbers) {
      counts[static_cast<Index>(group)] += 1.0;
    }
    const auto place = static_cast<Index>(k);
    if (!(information(place, place) > kRounding * counts.squaredNorm())) {
      return with_term("groups and predictors go together", k, terms.size());
    }
  }
  const VectorXd scale = information.diagonal().cwiseSqrt().cwiseInverse();
  const MatrixXd scaled = scale.asDiagonal() * information * scale.asDiagonal();
  if (terms.size() > 1 && !(solve_pivoted(scaled, scale).smallest > kRounding)) {
    return "two random terms group the observations alike";
  }
  return std::nullopt;
}

/// Twice the inverse Hessian of the criterion by the logarithms of the residual variance and of the
/// positive rhos; nothing if it is not positive definite.
std::optional<MatrixXd> parameter_covariance(const Slopes& s, const std::vector<Index>& positive,
                                             double df) {
  const Index count = std::ssize(positive) + 1;
  MatrixXd hessian(count, count);
  hessian(0, 0) = df;
  for (Index i = 1; i < count; ++i) {
    const Index k = positive[static_cast<std::size_t>(i - 1)];
    hessian(i, 0) = hessian(0, i) = s.rho[k] * s.effects[k] / s.within;
    for (Index j = 1; j <= i; ++j) {
      const Index m = positive[static_cast<std::size_t>(j - 1)];
      // The information of the profiled criterion, and the part that profiling took away.
      const double profiled = s.effects[k] * s.effects[m] / (df * s.within * s.within);
      hessian(i, j) = hessian(j, i) = s.rho[k] * s.rho[m] * (s.hessian(k, m) + profiled);
    }
  }
  std::optional<MatrixXd> inverse = solve_positive(hessian, MatrixXd::Identity(count, count));
  if (inverse) {
    *inverse *= 2.0;
  }
  return inverse;
}

/// Nothing if a coefficient has no degrees of freedom: the variance between groups cannot be
/// told from the predictors then.
std::optional<MixedModel> described(const CenteredDesign& design, const Slopes& s, double df,
                                    double origin, double level) {
  MixedModel model;
  std::vector<Index> positive;
  for (Index k = 0; k < s.rho.size(); ++k) {
    model.variances.push_back(s.rho[k] * s.within);
    if (s.rho[k] > 0.0) {
      positive.push_back(k);
    }
  }
  model.at_boundary = positive.size() < model.variances.size();
  model.variance_within = s.within;
  // The criterion has the determinant of the scaled columns.
  model.log_likelihood = -0.5 * s.criterion - design.scales.array().log().sum();
  const MatrixXd back = design.back();
  model.root = std::sqrt(s.within) * back * s.root;
  model.leverage.push_back(MatrixXd::Identity(back.rows(), back.rows()));
  for (const Index k : positive) {
    model.leverage.push_back(s.rho[k] * s.leverage[static_cast<std::size_t>(k)]);
  }
  const auto parameters = parameter_covariance(s, positive, df);
  if (!parameters) {
    return std::nullopt;
  }
  model.parameters = *parameters;
  VectorXd estimates = back * s.coefficients;
  estimates[0] += origin;
  for (const double estimate : estimates) {
    model.coefficients.push_back({.estimate = estimate});
  }
  for (Index k = 0; k < estimates.size(); ++k) {
    const auto tested = contrast(model, VectorXd::Unit(estimates.size(), k), level);
    if (!tested) {
      return std::nullopt;
    }
    model.coefficients[static_cast<std::size_t>(k)] = *tested;
  }
  return model;
}

void check_terms(std::span<const double> response, const MatrixXd& predictors,
                 const std::vector<std::vector<std::size_t>>& terms) {
  bool equal = predictors.rows() == std::ssize(response);
  for (const auto& term : terms) {
    equal = equal && term.size() == response.size();
  }
  if (!equal) {
    throw std::invalid_argument("mixed_model: the lengths differ");
  }
}

/// Why these groups make no random term.
std::optional<std::string> no_term(const Grouping& term, std::size_t observations) {
  if (term.count < 2) {
    return "there is only one group";
  }
  if (term.count == observations) {
    return "every group has a single value";
  }
  return std::nullopt;
}

}  // namespace

Defined<MixedModel> mixed_model(std::span<const double> response, const MatrixXd& predictors,
                                const std::vector<std::vector<std::size_t>>& terms, double level) {
  check_terms(response, predictors, terms);
  const auto m = moments(response);
  if (!m) {
    return Undefined{m.because()};
  }
  std::vector<Grouping> groupings;
  for (std::size_t k = 0; k < terms.size(); ++k) {
    groupings.push_back(grouping_of(terms[k]));
    if (const auto reason = no_term(groupings.back(), response.size())) {
      return Undefined{with_term(*reason, k, terms.size())};
    }
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
  const RestrictedLikelihood likelihood(design->columns, shifted, groupings);
  if (likelihood.within_squares() <= rounding_of(response)) {
    return Undefined{kExact};
  }
  if (const auto reason = confounded(likelihood, groupings)) {
    return Undefined{*reason};
  }
  const auto point = lowest_point(likelihood);
  if (!point) {
    return Undefined{kExact};
  }
  auto model = described(*design, *point, likelihood.df(), m->mean(), level);
  if (!model) {
    return Undefined{"a coefficient has no degrees of freedom: groups and predictors go together"};
  }
  model->observations = response.size();
  for (const Grouping& term : groupings) {
    model->groups.push_back(term.count);
  }
  return *model;
}

Defined<MixedModel> random_intercept_model(std::span<const double> response,
                                           const MatrixXd& predictors,
                                           std::span<const std::size_t> groups, double level) {
  return mixed_model(response, predictors, {{groups.begin(), groups.end()}}, level);
}

}  // namespace haptrial::analysis
