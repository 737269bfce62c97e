#pragma once

#include <limits>
#include <span>
#include <string>
#include <vector>

#include "analysis/psychometric/fit/likelihood_fit.h"
#include "analysis/psychometric/fit/profile_interval.h"

namespace haptrial::analysis {

/// Intervals of listed levels are widened if answers scatter as much in fewer than this share of
/// samples; at 0.05 too many intervals of scattered answers stay short.
inline constexpr double kUnusualScatter = 0.2;

/// The estimates and intervals that a report states of a function, from one method, and what is
/// wrong with them.
struct StatedFit {
  LikelihoodFit likeliest;
  FittedParameters estimate;  // of the likelihood; of adaptive trials the posterior's medians
  ProfileInterval threshold, width;     // [axis]; of adaptive trials of the posterior
  ProfileInterval lapse, guess;         // of adaptive trials; a point if the rate is known
  std::vector<FittedParameters> draws;  // of the posterior of adaptive trials
  bool told{false};                     // the answers tell the threshold and, if listed, the width
  bool lapse_told{true};                // adaptive trials: the interval is not that of the prior
  bool lapse_at_bound{false};           // the likeliest rate is the highest that is allowed
  bool guess_at_bound{false};
  /// How much longer the answers' scatter makes the intervals of listed levels; 1: as chance has
  /// it.
  double widening{1.0};
  /// By which the scatter was judged; NaN: it was not.
  double deviance_p{std::numeric_limits<double>::quiet_NaN()};
  /// Why the intervals do not hold the truth as often as they would say; empty: they do.
  std::string no_interval;

  /// Whether the threshold may lie anywhere beyond one end of its interval.
  bool open() const noexcept { return threshold.low_open || threshold.high_open; }
};

/// Fits a function. Listed levels: maximum likelihood with profile intervals. Levels that followed
/// from answers: medians and central 95 % of adaptive_posterior(). A side of the posterior's
/// threshold is open if the prior ends it: if the density there is above exp(-1.92) of the largest,
/// which a likelihood-ratio test would not reject. There is no interval if more lapses or
/// guesses than are allowed make the answers likelier by a factor sqrt(e). If answers to listed
/// levels scatter more than chance does in four of five cases (deviance_p < kUnusualScatter), the
/// profile's cut is that of an F test with the deviance over its degrees of freedom as the scale
/// (quasi-likelihood).
/// @param adaptive    the levels depended on the answers
/// @param deviance_p  of bootstrap_fit(); NaN: no samples were drawn, and chi-square gives it if
///   levels have five trials on average
/// @throws std::invalid_argument as LikelihoodFitter
/// Source: McCullagh and Nelder 1989, Generalized Linear Models, 4.5 (the scale).
StatedFit stated_fit(std::span<const TrialBlock> blocks, const LikelihoodOptions& options,
                     bool adaptive, double deviance_p);

}  // namespace haptrial::analysis
