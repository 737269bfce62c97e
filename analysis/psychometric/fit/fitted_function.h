#pragma once

#include <cstdint>

#include "core/psychometric/function/psychometric_function.h"

namespace haptrial::analysis {

/// Meaning of the lower asymptote.
enum class Task : std::uint8_t {
  kYesNo,           // a parameter of its own
  kForcedChoice,    // known: the guess rate of the function, 1 / alternatives
  kEqualAsymptote,  // the lapse rate
};

/// Result of a fit. Threshold and width are on the axis of the function: with parameters_named() of
/// a logarithmic sigmoid, in natural logarithms of the level, as in psignifit.
struct FittedParameters {
  double threshold{0.0};
  double width{1.0};  // > 0
  double lapse{0.0};  // in [0, 1) [1]
  double guess{0.0};  // in [0, 1) [1]
  double eta{0.0};    // overdispersion, in [0, 1): 0 is the binomial distribution [1]
};

/// The function that a fit found, for procedures, observers and predictions.
/// @param shape  whose sigmoid, axis, share, tail and direction it has
/// @throws std::invalid_argument naming the parameter that breaks its bound.
psychometric::PsychometricFunction fitted_function(
    const psychometric::PsychometricParameters& shape, const FittedParameters& fitted);

/// The same for many fits of one shape. @param curve  curve_of(shape)
psychometric::PsychometricFunction fitted_function(
    const psychometric::PsychometricParameters& shape, const psychometric::SigmoidCurve& curve,
    const FittedParameters& fitted);

/// @throws std::invalid_argument unless the guess rate of a forced choice lies inside (0, 1).
void check_task(Task task, const psychometric::PsychometricParameters& shape);

}  // namespace haptrial::analysis
