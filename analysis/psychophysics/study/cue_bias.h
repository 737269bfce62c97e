#pragma once

#include <span>
#include <string>

#include "analysis/psychophysics/fit/function_fit.h"

namespace haptrial::analysis::trials {

/// Functions of one participant under conditions that count as one: their standard deviations by
/// the geometric mean. Each is defined.
using FunctionFits = std::span<const FunctionFit* const>;

/// Effect of the errors of fitted functions on the comparison of one participant's cues with the
/// best combination, in the mean. Fits of few answers are a little too steep, more so where levels
/// are far apart; and the prediction bends.
struct CueBias {
  double log_sd{0.0};  // log observed - log predicted standard deviation
  double weight{0.0};  // predicted - true weight of the first cue
};

/// Bias by answers to the same levels, drawn anew from the fitted functions of one cue and from
/// functions of both that are as steep as the prediction; then fitted as the true ones. What does
/// not tell a function does not count, as it does not in a study.
/// @param stream  name of the random numbers; their seed is the plan's
/// Source of the method: Efron and Tibshirani 1993, An Introduction to the Bootstrap, 10.
CueBias cue_bias(FunctionFits first, FunctionFits second, FunctionFits both, const TrialsPlan& plan,
                 const std::string& stream);

}  // namespace haptrial::analysis::trials
