#pragma once

#include <span>

#include "analysis/reaching/learning_curve.h"
#include "analysis/reaching/participant_intervals.h"

namespace haptrial::analysis {

/// y(n) = asymptote + amplitude exp(-n / time_constant), n = 0, 1, ... the cycle.
struct ExponentialFit {
  double asymptote{0.0};      // where learning ends
  double amplitude{0.0};      // y(0) - asymptote
  double time_constant{1.0};  // [cycles]
  double deviation{0.0};      // standard deviation of the residuals
  double r_squared{0.0};

  double rate() const { return 1.0 / time_constant; }  // per cycle
  double at(double cycle) const;
};

/// Least squares: at each time constant the other two follow from a linear fit, and Brent's search
/// (GSL) finds the time constant between 0.1 and ten times the number of cycles.
/// @param weights  as many as the values, >= 0 (number of participants of a mean); empty: all 1.
/// A value of weight 0 does not count.
/// Undefined with fewer than five values, one that is not finite, values that do not vary, or when
/// the best time constant lies at a bound: the values do not level off, or only the first differs.
/// @throws std::invalid_argument when the lengths differ.
Defined<ExponentialFit> fit_exponential(std::span<const double> values,
                                        std::span<const double> weights = {});

/// The fit to the means of the cycles, with intervals by resampling participants. A draw whose time
/// constant ends at a bound counts with that bound; an interval that ends there is open, infinite.
struct LearningFit {
  ExponentialFit fit;
  Defined<BootstrapInterval> asymptote, amplitude, time_constant;
  std::size_t at_bound{0};  // draws whose time constant ended at a bound
};

/// The same numbers for any number of threads. Undefined as fit_exponential.
Defined<LearningFit> fit_learning(const CycleTable& table, const ParticipantResampling& how = {});

}  // namespace haptrial::analysis
