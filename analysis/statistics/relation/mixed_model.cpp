#include "analysis/statistics/relation/mixed_model.h"

#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>

#include "analysis/statistics/base/decomposition.h"
#include "analysis/statistics/base/descriptive.h"
#include "analysis/statistics/relation/centered_design.h"
#include "analysis/statistics/relation/mixed_contrast.h"
#include "analysis/statistics/relation/variance_search.h"

namespace haptrial::analysis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Slopes = RestrictedLikelihood::Slopes;

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
