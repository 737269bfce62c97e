#pragma once

#include <functional>
#include <string>

#include "analysis/statistics/base/defined.h"
#include "analysis/statistics/tests/sample_size.h"

namespace haptrial::analysis {

/// Power over a size or an effect; rises.
using PowerCurve = std::function<double(double)>;

/// The share of the noncentral F that lies beyond the critical value of the central one.
/// @param alpha  above 0 and below 1; both df above 0; lambda >= 0
double f_power(double alpha, double df_numerator, double df_denominator, double lambda);

/// The first size, at least the smallest, at which the curve reaches the power.
/// Undefined where ten million participants would not do.
Defined<SampleSize> size_reaching(const PowerCurve& curve, double power, double smallest = 2.0);
/// The effect likewise. Undefined above 100 standard deviations.
Defined<double> effect_reaching(const PowerCurve& curve, double power);

/// Fault of a plan, as a part of a sentence; empty: none.
std::string problem_of_plan(double alpha, double n, double effect);
std::string problem_of_power(double alpha, double power);

}  // namespace haptrial::analysis
