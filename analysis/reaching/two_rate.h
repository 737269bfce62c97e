#pragma once

#include <limits>
#include <span>
#include <vector>

#include "analysis/reaching/participant_intervals.h"
#include "analysis/statistics/base/defined.h"

namespace haptrial::analysis {

/// Two processes that learn from the same error, one fast and forgetful, one slow:
///
///     x(n)     = x_f(n) + x_s(n)                 the adaptation, in units of the perturbation
///     e(n)     = f(n) - x(n)                     the error; 0 in an error clamp
///     x_f(n+1) = A_f x_f(n) + B_f e(n)           retention A, learning B
///     x_s(n+1) = A_s x_s(n) + B_s e(n)           x_f(0) = x_s(0) = 0, A_f < A_s
///
/// Source: Smith, Ghazizadeh and Shadmehr 2006, PLoS Biology 4, e179.
struct TwoRateModel {
  struct Process {
    double retention{0.0};  // A in (0, 1)
    double learning{0.0};   // B in (0, 1)
  };
  Process fast{0.59, 0.21};
  Process slow{0.992, 0.02};
  double error_scale{1.0};  // measured error = error_scale e: its unit per unit of perturbation
};

struct AdaptationTrial {
  double perturbation{0.0};  // f(n): 1 the field, 0 none or a catch trial, -1 the opposite field
  bool error_clamp{false};   // a channel holds the error at 0 and shows the adaptation itself
  /// Measured value: x in a clamp (an adaptation index), error_scale e elsewhere. NaN: nothing, as
  /// where the reach was not sound; it still counts as a trial.
  double measured{std::numeric_limits<double>::quiet_NaN()};
};
using AdaptationSequence = std::vector<AdaptationTrial>;

struct TwoRateOptions {
  bool fit_error_scale{false};  // otherwise the scale of `start` is kept
  TwoRateModel start{};         // one of five points from which the search begins
};

struct TwoRateFit {
  TwoRateModel model;
  TwoRateModel errors;    // standard errors, taking residuals as independent; 0 for what is kept
  double squares{0.0};    // sum of squared residuals
  double deviation{0.0};  // standard deviation of the residuals
  std::size_t count{0};   // of measured values
};

/// Least squares over all sequences together, one parameter set for all of them (Levenberg and
/// Marquardt, exact derivatives, retentions and learning rates kept inside (0, 1)).
/// Undefined with fewer than eight measured values, a perturbation that is not finite, no solution,
/// or parameters that these trials cannot tell apart.
Defined<TwoRateFit> fit_two_rate(std::span<const AdaptationSequence> sequences,
                                 const TwoRateOptions& options = {});

/// Learning with intervals by resampling participants, one sequence each.
struct TwoRateLearning {
  TwoRateFit fit;
  Defined<BootstrapInterval> fast_retention, fast_learning, slow_retention, slow_learning;
};

/// Each draw is searched from the fit of everybody. Undefined as fit_two_rate.
Defined<TwoRateLearning> fit_two_rate_learning(
    std::span<const AdaptationSequence> participants, const TwoRateOptions& options = {},
    const ParticipantResampling& how = {.resampling = {.stream = "two-rate", .count = 1999}});

}  // namespace haptrial::analysis
