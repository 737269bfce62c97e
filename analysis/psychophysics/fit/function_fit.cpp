#include "analysis/psychophysics/fit/function_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <stdexcept>

#include "analysis/psychometric/fit/stated_fit.h"
#include "analysis/statistics/base/descriptive.h"

namespace haptrial::analysis::trials {
namespace {

constexpr double kLevel = 0.95;  // of intervals
constexpr std::array kBandShares{0.05, 0.1, 0.2, 0.35, 0.5, 0.65, 0.8, 0.9, 0.95};

/// "larger" or "smaller": the function crosses 1/2 at the standard, and its spread is what counts.
Reading weber_reading(const TrialsPlan& plan) {
  const double guess = plan.guess_free ? 0.0 : plan.function.guess;
  return guess == 0.0 ? Reading::kWeberQuartiles : Reading::kWeberThreshold;
}

std::vector<BootstrapTarget> asked_of(const TrialsPlan& plan) {
  const double share = plan.function.share;
  std::vector<BootstrapTarget> asked{{Reading::kLevelOfShare, share},
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

Estimated as_levels(const Estimated& x, const psychometric::Axis& axis) {
  const auto level = [&](double end) { return std::isinf(end) ? end : axis.level(end); };
  return {axis.level(x.value), level(x.low), level(x.high)};
}

/// Threshold and width.
void take_stated(FunctionReadings& r, const StatedFit& fit, const TrialsPlan& plan) {
  r.x = within(fit.estimate.threshold, fit.threshold, -std::numeric_limits<double>::infinity());
  r.threshold = as_levels(r.x, plan.function.axis);
  r.width = within(fit.estimate.width, fit.width, 0.0);
}

/// The median of the draws of a number that is read off a function, with its central interval.
Estimated drawn(const StatedFit& fit, const TrialsPlan& plan, const BootstrapTarget& asked) {
  const auto curve = psychometric::curve_of(plan.function);
  std::vector<double> numbers;
  for (const FittedParameters& draw : fit.draws) {
    numbers.push_back(read_off(fitted_function(plan.function, curve, draw), asked));
  }
  const auto at = [&](double share) {
    const auto found = quantile(numbers, share);
    return found ? *found : kNotKnown;
  };
  return {at(0.5), at(0.5 - 0.5 * kLevel), at(0.5 + 0.5 * kLevel)};
}

/// Reads slope, Weber fraction and band off draws from the posterior of adaptive trials.
void take_draws(FunctionFit& result, FunctionReadings& r, const StatedFit& fit,
                const TrialsPlan& plan) {
  r.slope = drawn(fit, plan, {Reading::kSlope, plan.function.share});
  r.lapse = within(fit.estimate.lapse, fit.lapse, 0.0);
  if (plan.guess_free) {
    r.guess = within(fit.estimate.guess, fit.guess, 0.0);
  }
  if (plan.reference) {
    r.weber = drawn(fit, plan, {weber_reading(plan), plan.function.share, *plan.reference});
    r.weber.high = fit.open() ? std::numeric_limits<double>::infinity() : r.weber.high;
  }
  for (BandPoint& point : result.band) {
    point.level = drawn(fit, plan, {Reading::kLevelOfShare, point.share});
  }
}

Estimated on_axis(const Estimated& level, const psychometric::Axis& axis) {
  const auto at = [&](double value) {
    const double x = std::isfinite(value) ? axis.at(value) : kNotKnown;
    return std::isfinite(x) ? x : kNotKnown;
  };
  return {at(level.value), at(level.low), at(level.high)};
}

/// Intervals that would not hold the truth as often as they say.
void remove_intervals(FunctionFit& result, FunctionReadings& r) {
  for (Estimated* e : {&r.threshold, &r.x, &r.width, &r.slope, &r.weber, &r.lapse, &r.guess}) {
    remove_interval(*e);
  }
  for (BandPoint& point : result.band) {
    remove_interval(point.level);
  }
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

/// Fit without a bootstrap: readings alone.
BootstrappedFit bare_fit(const std::vector<TrialBlock>& blocks, const LikelihoodOptions& options,
                         const std::vector<BootstrapTarget>& asked) {
  BootstrappedFit result;
  result.fit = likelihood_fit(blocks, options);
  const auto function = fitted_function(options.function, result.fit.parameters);
  result.deviance = deviance_of(function, blocks);
  for (const BootstrapTarget& each : asked) {
    result.estimates.push_back(read_off(function, each));
  }
  return result;
}

/// The intervals of listed levels that are no profile's.
void take_scatter(FunctionFit& result, FunctionReadings& r, const StatedFit& fit,
                  const TrialsPlan& plan, const LikelihoodOptions& options) {
  widen_log(r.slope, fit.widening);
  widen_log(r.weber, fit.widening);
  widen_rate(r.lapse, fit.widening, options.lapse);
  widen_rate(r.guess, fit.widening, options.guess);
  for (BandPoint& point : result.band) {
    Estimated x = on_axis(point.level, plan.function.axis);
    widen(x, fit.widening);
    point.level = as_levels(x, plan.function.axis);
  }
  if (const Estimated weber = converted_weber(r, plan); weber.known()) {
    r.weber = weber;
  }
}

void add_warnings(FunctionFit& result, const StatedFit& fit, const TrialsPlan& plan) {
  std::vector<std::string>& warnings = result.warnings;
  if (!fit.no_interval.empty()) {
    warnings.push_back("there is no interval: " + fit.no_interval);
  }
  if (fit.widening > 1.0) {
    warnings.push_back(fmt::format(
        "the intervals are {:.1f} times as long as chance alone would make them (p = {:.3f} of the "
        "deviance)",
        fit.widening, result.deviance_p));
  }
  if (fit.lapse_at_bound) {
    warnings.push_back(
        fmt::format("the lapse rate ended at its bound of {}; it may be higher", plan.lapse.high));
  }
  if (fit.guess_at_bound) {
    warnings.emplace_back("the guess rate ended at its bound; it may be higher");
  }
  if (fit.open()) {
    warnings.emplace_back("the answers leave a side of the threshold's interval open");
  }
}

/// Why the answers tell no function.
std::string untold_because(const FunctionFit& result, const StatedFit& fit,
                           LikelihoodOptions options) {
  options.function.falling = !options.function.falling;
  const LikelihoodFit turned = likelihood_fit(result.blocks, options);
  constexpr double kRejected = 1.92;  // half the 95 % quantile of chi-square, 1
  if (turned.log_likelihood > fit.likeliest.log_likelihood + kRejected) {
    return options.function.falling
               ? "the share of answers 1 falls with the level, and the function rises; a name with "
                 "neg_ falls"
               : "the share of answers 1 rises with the level, and the function falls";
  }
  return fit.open() ? "the threshold may lie beyond what was presented"
                    : "the answers do not tell threshold and width";
}

void fit_stated(FunctionFit& result, const LikelihoodOptions& options, const TrialsPlan& plan,
                int threads) {
  std::vector<BootstrapTarget> asked = asked_of(plan);
  const std::size_t band = asked.size();
  for (const double share : kBandShares) {
    asked.push_back({Reading::kLevelOfShare, share});
  }
  FitBootstrap how = bootstrap_of(result.participant, result.condition);
  how.resampling.seed = plan.seed;
  how.resampling.count = plan.resamples;
  how.resampling.threads = threads;
  const bool bootstrapped = plan.resamples > 0;
  const BootstrappedFit fit = bootstrapped ? bootstrap_fit(result.blocks, options, asked, how)
                                           : bare_fit(result.blocks, options, asked);
  result.deviance = fit.deviance.deviance;
  const StatedFit stated = stated_fit(result.blocks, options, result.adaptive,
                                      bootstrapped ? fit.deviance_p : kNotKnown);
  result.deviance_p = stated.deviance_p;
  if (!fit.fit.undetermined) {
    result.likeliest = fit.fit.parameters;
  }
  if (!stated.told) {
    result.stated = Undefined{untold_because(result, stated, options)};
    return;
  }
  result.fitted = stated.estimate;
  result.no_interval = stated.no_interval;
  result.lapse_told = stated.lapse_told;
  FunctionReadings readings = readings_of(fit, plan);
  for (std::size_t i = 0; bootstrapped && i < kBandShares.size(); ++i) {
    result.band.push_back({kBandShares[i], estimated(fit, band + i)});
  }
  take_stated(readings, stated, plan);
  if (result.adaptive) {
    take_draws(result, readings, stated, plan);
  } else {
    take_scatter(result, readings, stated, plan, options);
  }
  if (!stated.no_interval.empty()) {
    remove_intervals(result, readings);
  }
  result.stated = readings;
  if (bootstrapped && !result.adaptive && fit.undetermined > plan.resamples / 20) {
    result.warnings.push_back(
        fmt::format("{} of {} bootstrap samples do not tell threshold and width", fit.undetermined,
                    plan.resamples));
  }
  add_warnings(result, stated, plan);
}

Estimated marginal(const BayesianFit& fit, Dimension dimension, double value) {
  Estimated e{value};
  if (!fit.intervals[dimension].empty()) {
    e.low = fit.intervals[dimension].front().low;
    e.high = fit.intervals[dimension].front().high;
  }
  return e;
}

void fit_bayesian(FunctionFit& result, const LikelihoodOptions& likelihood, const TrialsPlan& plan,
                  int threads) {
  BayesianOptions options;
  options.range = range_of(likelihood, coordinates(plan.function.axis, result.blocks));
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
  r.threshold = as_levels(r.x, axis);
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
  options.guess.high = kMostLapses;
  if (!plan.guess_free && !plan.guess_is_lapse && plan.function.guess == 0.0) {
    options.task = Task::kYesNo;  // a guess rate that is known to be 0
    options.guess = {0.0, 0.0};
  }
  return options;
}

std::optional<SearchBounds> range_on_axis(const std::optional<psychometric::LevelRange>& range,
                                          const psychometric::Axis& axis) {
  if (!range || !std::isfinite(axis.at(range->low)) || !std::isfinite(axis.at(range->high))) {
    return std::nullopt;
  }
  return SearchBounds{axis.at(range->low), axis.at(range->high)};
}

psychometric::PsychometricFunction FunctionFit::function(const TrialsPlan& plan) const {
  if (!stated) {
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
  const auto presented = [](const TrialBlock& b) { return b.level != kNoStimulus; };
  const auto outside = [&](const TrialBlock& b) {
    return b.level != kNoStimulus && !std::isfinite(plan.function.axis.at(b.level));
  };
  if (std::any_of(result.blocks.begin(), result.blocks.end(), outside)) {
    result.warnings.push_back(fmt::format("levels at or below the axis's origin of {} are left out",
                                          plan.function.axis.origin));
    std::erase_if(result.blocks, outside);
  }
  if (std::ranges::count_if(result.blocks, presented) < 2) {
    const Undefined why{"there are answers at fewer than two levels"};
    result.stated = why;
    result.bayesian = why;
    return result;
  }
  LikelihoodOptions options = likelihood_options(plan);
  options.presentable = range_on_axis(series.range, plan.function.axis);
  if (series.catches.total > 0) {
    options.guess.high = kLargestRate;
  }
  fit_stated(result, options, plan, threads);
  if (plan.bayesian) {
    fit_bayesian(result, options, plan, threads);
  } else {
    result.bayesian = Undefined{"the definition does not ask for it"};
  }
  return result;
}

}  // namespace haptrial::analysis::trials
