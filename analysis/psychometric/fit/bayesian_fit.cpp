#include "analysis/psychometric/fit/bayesian_fit.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "analysis/psychometric/fit/posterior.h"
#include "analysis/statistics/base/solvers.h"

namespace haptrial::analysis {
namespace {

using Steps = std::array<int, kDimensions>;
using Borders = std::array<PsychometricPrior::Border, kDimensions>;

void check_bayesian(const BayesianOptions& options) {
  check_task(options.task, options.function);
  if (!(options.border_mass >= 0.0 && options.border_mass < 1.0)) {
    throw std::invalid_argument("border_mass must lie in [0, 1)");
  }
  for (const double level : options.levels) {
    if (!(level > 0.0 && level < 1.0)) {
      throw std::invalid_argument("levels of the intervals must lie inside (0, 1)");
    }
  }
  for (std::size_t d = 0; d < kDimensions; ++d) {
    if (options.steps[d] < 0 || options.first_steps[d] < 0) {
      throw std::invalid_argument("steps and first_steps must not be negative");
    }
    const auto& value = options.fixed[d];
    const bool rate = d >= kLapse;
    if (value && !(std::isfinite(*value) && (d != kWidth || *value > 0.0) &&
                   (!rate || (*value >= 0.0 && *value < 1.0)))) {
      throw std::invalid_argument(
          "fixed: a width must be above 0, a rate and the overdispersion must lie in [0, 1)");
    }
  }
}

Steps steps_of(const Steps& given, const Steps& usual) {
  Steps result;
  for (std::size_t d = 0; d < kDimensions; ++d) {
    result[d] = given[d] > 0 ? given[d] : usual[d];
  }
  return result;
}

std::vector<double> spaced(const PsychometricPrior::Border& border, int count) {
  if (count == 1 || border.high == border.low) {
    return {border.low};
  }
  std::vector<double> values;
  for (int i = 0; i < count; ++i) {
    values.push_back(border.low + (border.high - border.low) * i / (count - 1));
  }
  values.back() = border.high;
  return values;
}

GridAxes axes_of(const Borders& borders, const Steps& steps) {
  GridAxes axes;
  for (std::size_t d = 0; d < kDimensions; ++d) {
    axes[d] = spaced(borders[d], steps[d]);
  }
  return axes;
}

/// Borders of the prior, or a fixed value.
Borders first_borders(const PsychometricPrior& prior, const BayesianOptions& options) {
  Borders borders;
  for (std::size_t d = 0; d < kDimensions; ++d) {
    borders[d] = prior.border(static_cast<Dimension>(d));
    if (options.fixed[d]) {
      borders[d] = {*options.fixed[d], *options.fixed[d]};
    }
  }
  if (options.task == Task::kForcedChoice) {
    borders[kGuess] = {options.function.guess, options.function.guess};
  } else if (options.task == Task::kEqualAsymptote) {
    borders[kGuess] = {0.0, 0.0};  // follows the lapse rate
  }
  return borders;
}

/// Borders from the step before the first that holds the mass to the one after the last.
Borders kept(const std::array<Marginal, kDimensions>& marginals, double mass) {
  Borders borders;
  for (std::size_t d = 0; d < kDimensions; ++d) {
    const Marginal& m = marginals[d];
    std::size_t first = m.values.size() - 1, last = 0;
    for (std::size_t i = 0; i < m.values.size(); ++i) {
      if (m.density[i] * m.weights[i] >= mass) {
        first = std::min(first, i);
        last = std::max(last, i);
      }
    }
    borders[d] = {m.values[first > 0 ? first - 1 : 0],
                  m.values[std::min(last + 1, m.values.size() - 1)]};
  }
  return borders;
}

FittedParameters parameters_of(const std::array<double, kDimensions>& p, Task task) {
  return {p[kThreshold], p[kWidth], p[kLapse],
          task == Task::kEqualAsymptote ? p[kLapse] : p[kGuess], p[kEta]};
}

/// Climbs from a place of the grid. Rates are squares of what is searched, and the width is an
/// exponential, so that no border is in the way.
std::array<double, kDimensions> climbed(const PsychometricPosterior& posterior, Task task,
                                        const GridAxes& axes,
                                        const std::array<std::size_t, kDimensions>& place) {
  std::array<double, kDimensions> point;
  std::vector<std::size_t> free;
  std::vector<double> start, steps;
  for (std::size_t d = 0; d < kDimensions; ++d) {
    point[d] = axes[d][place[d]];
    if (axes[d].size() > 1) {
      free.push_back(d);
      const double step = axes[d][1] - axes[d][0];
      start.push_back(d == kThreshold ? point[d]
                      : d == kWidth   ? std::log(point[d])
                                      : std::sqrt(point[d]));
      steps.push_back(d == kThreshold ? step : d == kWidth ? 0.1 : 0.5 * std::sqrt(step));
    }
  }
  const auto set = [&](std::span<const double> searched) {
    for (std::size_t i = 0; i < free.size(); ++i) {
      const double x = searched[i];
      point[free[i]] = free[i] == kThreshold ? x : free[i] == kWidth ? std::exp(x) : x * x;
    }
    return -posterior.log_density(parameters_of(point, task));
  };
  if (!free.empty()) {
    set(find_minimum(set, start, steps).at);
  }
  return point;
}

void add_intervals(BayesianFit& fit, const PsychometricPosterior::Masses& masses,
                   const GridAxes& axes, const BayesianOptions& options) {
  for (const double level : options.levels) {
    std::array<CredibleInterval, kDimensions> found;
    if (options.method == CredibleMethod::kProject) {
      found = projected(masses, axes, level);
    } else {
      for (std::size_t d = 0; d < kDimensions; ++d) {
        found[d] = percentiles(fit.marginals[d], level);
      }
    }
    for (std::size_t d = 0; d < kDimensions; ++d) {
      fit.intervals[d].push_back(found[d]);
    }
  }
}

/// The guess rate of an equal asymptote is the lapse rate in all.
void follow_lapse(BayesianFit& fit) {
  fit.marginals[kGuess] = fit.marginals[kLapse];
  fit.intervals[kGuess] = fit.intervals[kLapse];
}

}  // namespace

BayesianFit bayesian_fit(std::span<const TrialBlock> blocks, const BayesianOptions& options) {
  check_bayesian(options);
  const Steps first_usual =
      options.task == Task::kYesNo ? Steps{25, 30, 10, 10, 15} : Steps{30, 40, 10, 1, 20};
  const Steps usual =
      options.task == Task::kYesNo ? Steps{40, 40, 20, 20, 20} : Steps{40, 40, 20, 1, 20};
  BayesianFit fit;
  fit.blocks = pooled(blocks);
  const StimulusRange range = options.range
                                  ? *options.range
                                  : stimulus_range(coordinates(options.function.axis, fit.blocks));
  if (!options.pool_levels) {
    fit.blocks.assign(blocks.begin(), blocks.end());
  }
  const psychometric::PsychometricParameters& function = options.function;
  const double usual_rate = psychometric::rate_of_width(function.sigmoid, 1.0);
  const double scale =
      psychometric::rate_of_width(function.sigmoid, 1.0, function.tail) / usual_rate;
  const PsychometricPrior prior(range, scale, options.beta_prior);
  const PsychometricPosterior posterior(function, options.task, fit.blocks, prior, options.fixed);

  const GridAxes first =
      axes_of(first_borders(prior, options), steps_of(options.first_steps, first_usual));
  const Borders borders =
      kept(marginals_of(posterior.on(first, options.threads), first), options.border_mass);
  const GridAxes axes = axes_of(borders, steps_of(options.steps, usual));
  const PsychometricPosterior::Masses masses = posterior.on(axes, options.threads);
  fit.marginals = marginals_of(masses, axes);
  std::array<double, kDimensions> mean;
  for (std::size_t d = 0; d < kDimensions; ++d) {
    mean[d] = mean_of(fit.marginals[d]);
  }
  fit.mean = parameters_of(mean, options.task);
  fit.map = parameters_of(climbed(posterior, options.task, axes, masses.largest), options.task);
  fit.log_posterior = posterior.log_density(fit.map);
  add_intervals(fit, masses, axes, options);
  if (options.task == Task::kEqualAsymptote) {
    follow_lapse(fit);
  }
  fit.deviance = deviance_of(fitted_function(function, fit.map), fit.blocks);
  fit.warnings = edge_warnings(fit.marginals, range);
  return fit;
}

}  // namespace haptrial::analysis
