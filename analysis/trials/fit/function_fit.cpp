#include "analysis/trials/fit/function_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "analysis/psychometric/fit/adaptive_posterior.h"
#include "analysis/psychometric/fit/profile_interval.h"
#include "analysis/statistics/base/descriptive.h"

namespace haptrial::analysis::trials {
namespace {

constexpr double kAtBound = 1e-3;  // of a lapse rate
constexpr double kLevel = 0.95;    // of intervals
constexpr std::array kBandShares{0.05, 0.1, 0.2, 0.35, 0.5, 0.65, 0.8, 0.9, 0.95};

/// "larger" or "smaller": the function crosses 1/2 at the standard, and its spread is what counts.
Reading weber_reading(const TrialsPlan& plan) {
  const double guess = plan.guess_free ? 0.0 : plan.function.guess;
  return guess == 0.0 ? Reading::kWeberQuartiles : Reading::kWeberThreshold;
}

std::vector<Asked> asked_of(const TrialsPlan& plan) {
  const double share = plan.function.share;
  std::vector<Asked> asked{{Reading::kLevelOfShare, share},
                           {Reading::kWidth},
                           {Reading::kSlope, share},
                           {Reading::kLapse},
                           {Reading::kGuess}};
  if (plan.reference) {
    asked.push_back({weber_reading(plan), share, *plan.reference});
  }
  return asked;
}

Estimated estimated(const BootstrappedFit& fit, std::size_t at) {
  Estimated e{fit.estimates[at]};
  if (at < fit.intervals.size() && fit.intervals[at]) {
    e.low = fit.intervals[at]->low;
    e.high = fit.intervals[at]->high;
  }
  return e;
}

/// The Weber fraction of a threshold above or below the standard, or of half the distance of the
/// quartiles on a linear axis.
Estimated converted_weber(const FunctionReadings& r, const TrialsPlan& plan) {
  if (!plan.reference) {
    return {};
  }
  const double standard = *plan.reference;
  if (weber_reading(plan) == Reading::kWeberThreshold) {
    const auto of = [&](double level) { return std::abs(level - standard) / standard; };
    Estimated e{of(r.threshold.value), of(r.threshold.low), of(r.threshold.high)};
    if (e.low > e.high) {
      std::swap(e.low, e.high);
    }
    const bool across = (r.threshold.low - standard) * (r.threshold.high - standard) < 0.0;
    e.low = across ? 0.0 : e.low;
    return e;
  }
  if (plan.function.axis.scale != psychometric::Scale::kLinear) {
    return {};
  }
  const auto curve = psychometric::curve_of(plan.function);
  const double share = (curve.z_for(0.75) - curve.z_for(0.25)) / curve.spread() / 2.0 / standard;
  const double k = std::abs(share);
  return {k * r.width.value, k * r.width.low, k * r.width.high};
}

/// A side without an end is infinite.
Estimated within(double value, const ProfileInterval& interval, double lowest) {
  constexpr double kOpen = std::numeric_limits<double>::infinity();
  return {value, interval.low_open ? lowest : interval.low,
          interval.high_open ? kOpen : interval.high};
}

/// Threshold and width, and what is one of them on another scale: their intervals hold the truth
/// more often than a bootstrap's.
void take_profile(FunctionReadings& r, const ProfiledFit& fit, const TrialsPlan& plan) {
  const psychometric::Axis& axis = plan.function.axis;
  r.x =
      within(fit.fit.parameters.threshold, fit.threshold, -std::numeric_limits<double>::infinity());
  r.threshold = {axis.level(r.x.value), axis.level(r.x.low), axis.level(r.x.high)};
  r.width = within(fit.fit.parameters.width, fit.width, 0.0);
  if (plan.reference) {
    const Estimated converted = converted_weber(r, plan);
    r.weber = converted.known() ? converted : r.weber;
  }
}

/// What the draws of a posterior leave open of a number that is read off a function.
Estimated drawn(double value, const AdaptivePosterior& posterior, const TrialsPlan& plan,
                const Asked& asked) {
  const auto curve = psychometric::curve_of(plan.function);
  std::vector<double> numbers;
  for (const FittedParameters& draw : posterior.draws) {
    numbers.push_back(read_off(fitted_function(plan.function, curve, draw), asked));
  }
  const auto low = quantile(numbers, 0.5 - 0.5 * kLevel);
  const auto high = quantile(numbers, 0.5 + 0.5 * kLevel);
  return {value, low ? *low : kNotKnown, high ? *high : kNotKnown};
}

/// The likeliest rate is often a bound, which a central interval leaves out.
Estimated as_far_as(double value, const CredibleInterval& interval) {
  return {value, std::min(value, interval.low), std::max(value, interval.high)};
}

/// The intervals of adaptive trials.
void take_posterior(FunctionFit& result, FunctionReadings& r, ProfiledFit& fit,
                    const TrialsPlan& plan) {
  const AdaptivePosterior posterior =
      adaptive_posterior(result.blocks, likelihood_options(plan), kLevel, kPosteriorDraws);
  fit.threshold = {posterior.threshold.low, posterior.threshold.high};
  fit.width = {posterior.width.low, posterior.width.high};
  r.slope = drawn(r.slope.value, posterior, plan, {Reading::kSlope, plan.function.share});
  r.lapse = as_far_as(r.lapse.value, posterior.lapse);
  if (plan.guess_free) {
    r.guess = as_far_as(r.guess.value, posterior.guess);
  }
  if (plan.reference) {
    r.weber = drawn(r.weber.value, posterior, plan,
                    {weber_reading(plan), plan.function.share, *plan.reference});
  }
  for (BandPoint& point : result.band) {
    point.level = drawn(point.level.value, posterior, plan, {Reading::kLevelOfShare, point.share});
  }
}

Estimated on_axis(const Estimated& level, const psychometric::Axis& axis) {
  const auto at = [&](double value) {
    const double x = std::isfinite(value) ? axis.at(value) : kNotKnown;
    return std::isfinite(x) ? x : kNotKnown;
  };
  return {at(level.value), at(level.low), at(level.high)};
}

FunctionReadings readings_of(const BootstrappedFit& fit, const TrialsPlan& plan) {
  FunctionReadings r;
  r.threshold = estimated(fit, 0);
  r.x = on_axis(r.threshold, plan.function.axis);
  r.width = estimated(fit, 1);
  r.slope = estimated(fit, 2);
  r.lapse = estimated(fit, 3);
  if (plan.guess_free) {
    r.guess = estimated(fit, 4);
  }
  if (plan.reference) {
    r.weber = estimated(fit, 5);
  }
  return r;
}

/// Without a bootstrap: readings alone.
BootstrappedFit bare_fit(const std::vector<TrialBlock>& blocks, const LikelihoodOptions& options,
                         const std::vector<Asked>& asked) {
  BootstrappedFit result;
  result.fit = likelihood_fit(blocks, options);
  const auto function = fitted_function(options.function, result.fit.parameters);
  result.deviance = deviance_of(function, blocks);
  for (const Asked& each : asked) {
    result.estimates.push_back(read_off(function, each));
  }
  return result;
}

void add_warnings(FunctionFit& fit, const TrialsPlan& plan) {
  const double most = plan.lapse.high;
  if (plan.lapse.high > plan.lapse.low && fit.fitted.lapse > most - kAtBound) {
    fit.warnings.push_back(
        fmt::format("the lapse rate ended at its bound of {}; it may be higher", most));
  }
  constexpr double kImprobable = 0.05;
  if (fit.deviance_p < kImprobable) {
    fit.warnings.push_back(fmt::format(
        "answers scatter more about the function than chance explains (deviance {:.1f}, "
        "p = {:.3f})",
        fit.deviance, fit.deviance_p));
  }
}

void fit_likelihood(FunctionFit& result, const TrialsPlan& plan, int threads) {
  const LikelihoodOptions options = likelihood_options(plan);
  std::vector<Asked> asked = asked_of(plan);
  const std::size_t band = asked.size();
  for (const double share : kBandShares) {
    asked.push_back({Reading::kLevelOfShare, share});
  }
  FitBootstrap how;
  how.resampling.seed = plan.seed;
  how.resampling.stream =
      fmt::format("psychometric bootstrap {} {}", result.participant, result.condition);
  how.resampling.count = plan.resamples;
  how.resampling.threads = threads;
  const bool bootstrapped = plan.resamples > 0;
  const BootstrappedFit fit = bootstrapped ? bootstrap_fit(result.blocks, options, asked, how)
                                           : bare_fit(result.blocks, options, asked);
  result.fitted = fit.fit.parameters;
  if (fit.fit.undetermined) {
    result.likelihood = Undefined{"the answers do not tell threshold and width"};
    return;
  }
  result.deviance = fit.deviance.deviance;
  result.deviance_p = bootstrapped ? fit.deviance_p : kNotKnown;
  FunctionReadings readings = readings_of(fit, plan);
  for (std::size_t i = 0; bootstrapped && i < kBandShares.size(); ++i) {
    result.band.push_back({kBandShares[i], estimated(fit, band + i)});
  }
  ProfiledFit profiled = profiled_fit(result.blocks, options);
  if (result.adaptive && plan.posteriors) {
    take_posterior(result, readings, profiled, plan);
  }
  take_profile(readings, profiled, plan);
  result.likelihood = readings;
  if (bootstrapped && fit.undetermined > plan.resamples / 20) {
    result.warnings.push_back(
        fmt::format("{} of {} bootstrap samples do not tell threshold and width", fit.undetermined,
                    plan.resamples));
  }
  add_warnings(result, plan);
}

Estimated marginal(const BayesianFit& fit, Dimension dimension, double value) {
  Estimated e{value};
  if (!fit.intervals[dimension].empty()) {
    e.low = fit.intervals[dimension].front().low;
    e.high = fit.intervals[dimension].front().high;
  }
  return e;
}

void fit_bayesian(FunctionFit& result, const TrialsPlan& plan, int threads) {
  BayesianOptions options;
  options.function = plan.function;
  options.task = plan.task();
  options.threads = threads;
  options.levels = {0.95};
  if (!plan.guess_free && !plan.guess_is_lapse && plan.function.guess == 0.0) {
    options.task = Task::kYesNo;
    options.fixed[kGuess] = 0.0;
  }
  if (plan.lapse.low == plan.lapse.high) {
    options.fixed[kLapse] = plan.lapse.low;
  }
  const BayesianFit fit = bayesian_fit(result.blocks, options);
  FunctionReadings r;
  r.x = marginal(fit, kThreshold, fit.mean.threshold);
  const psychometric::Axis& axis = plan.function.axis;
  r.threshold = {axis.level(r.x.value), axis.level(r.x.low), axis.level(r.x.high)};
  r.width = marginal(fit, kWidth, fit.mean.width);
  r.lapse = marginal(fit, kLapse, fit.mean.lapse);
  if (plan.guess_free) {
    r.guess = marginal(fit, kGuess, fit.mean.guess);
  }
  r.weber = converted_weber(r, plan);
  result.bayesian = r;
  result.overdispersion = fit.mean.eta;
  for (const std::string& warning : fit.warnings) {
    result.warnings.push_back("Bayesian fit: " + warning);
  }
}

}  // namespace

LikelihoodOptions likelihood_options(const TrialsPlan& plan) {
  LikelihoodOptions options;
  options.function = plan.function;
  options.task = plan.task();
  options.lapse = plan.lapse;
  if (!plan.guess_free && !plan.guess_is_lapse && plan.function.guess == 0.0) {
    options.task = Task::kYesNo;  // a guess rate that is known to be 0
    options.guess = {0.0, 0.0};
  }
  return options;
}

psychometric::PsychometricFunction FunctionFit::function(const TrialsPlan& plan) const {
  if (!likelihood) {
    throw std::logic_error("FunctionFit: the function is not defined");
  }
  return fitted_function(plan.function, fitted);
}

FunctionFit fit_series(const AnsweredSeries& series, const TrialsPlan& plan, int threads) {
  FunctionFit result;
  result.participant = series.participant;
  result.levels = series.levels;
  result.condition = series.condition();
  result.trials = series.trials.size();
  result.adaptive = series.adaptive;
  result.blocks = blocks_of(series);
  const auto outside = [&](const TrialBlock& b) {
    return !std::isfinite(plan.function.axis.at(b.level));
  };
  if (std::any_of(result.blocks.begin(), result.blocks.end(), outside)) {
    result.warnings.push_back(fmt::format("levels at or below the axis's origin of {} are left out",
                                          plan.function.axis.origin));
    std::erase_if(result.blocks, outside);
  }
  if (result.blocks.size() < 2) {
    const Undefined why{"there are answers at fewer than two levels"};
    result.likelihood = why;
    result.bayesian = why;
    return result;
  }
  fit_likelihood(result, plan, threads);
  if (plan.bayesian) {
    fit_bayesian(result, plan, threads);
  } else {
    result.bayesian = Undefined{"the definition does not ask for it"};
  }
  return result;
}

}  // namespace haptrial::analysis::trials
