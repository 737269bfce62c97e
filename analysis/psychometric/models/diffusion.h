#pragma once

#include <cstddef>
#include <span>

#include "analysis/statistics/base/defined.h"

namespace haptrial::analysis {

/// A diffusion between two boundaries, with a standard deviation of 1 per square root of a second:
///
///     dx = drift dt + dW,   x(0) = start * boundary,   answer and time: where and when x leaves
///     (0, boundary), non_decision later
struct Diffusion {
  double drift{0.0};         // towards the upper boundary [1/s^1/2]
  double boundary{1.0};      // > 0, from the lower to the upper one [s^1/2]
  double non_decision{0.0};  // [s]
  double start{0.5};         // inside (0, 1), share of the boundary
};

/// Density of an answer at `time` [1/s]; over both answers and all times it integrates to 1. The
/// series that needs fewer terms is summed until its rest is below 1e-12.
/// Source: Navarro and Fuss 2009, Journal of Mathematical Psychology 53.
double diffusion_density(const Diffusion& model, bool upper, double time) noexcept;

/// Share of answers at the upper boundary.
double diffusion_share(const Diffusion& model) noexcept;

/// One answer.
struct TimedChoice {
  bool upper{true};
  double time{0.0};  // [s]
};

struct DiffusionOptions {
  double start{0.5};         // inside (0, 1), fixed
  double contaminants{0.0};  // in [0, 1): share of guesses, even from 0 to the longest time
};

/// A parameter with its 95 % interval.
struct DiffusionEstimate {
  double value{0.0};
  double low{0.0}, high{0.0};
};

/// A fit, and how far it is from the data.
struct DiffusionFit {
  DiffusionEstimate drift, boundary, non_decision;
  double log_likelihood{0.0};
  std::size_t trials{0};
  std::size_t rarer{0};  // answers of the rarer kind
  /// Largest difference between the observed and the fitted distribution of times, those of lower
  /// answers counted negative (Voss and Voss 2007).
  double distance{0.0};
};

inline constexpr std::size_t kFewestTimedChoices = 40;

/// Drift, boundary and non-decision time by maximum likelihood, with intervals by profile
/// likelihood.
/// Undefined with fewer than kFewestTimedChoices answers or none of one kind, with
/// times that are not above 0, and if the likelihood does not determine a parameter.
/// @throws std::invalid_argument for options out of their range.
Defined<DiffusionFit> fit_diffusion(std::span<const TimedChoice> choices,
                                    const DiffusionOptions& options);

}  // namespace haptrial::analysis
