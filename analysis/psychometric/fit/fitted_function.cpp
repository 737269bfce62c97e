#include "analysis/psychometric/fit/fitted_function.h"

#include <stdexcept>

namespace haptrial::analysis {

using psychometric::PsychometricFunction;

PsychometricFunction fitted_function(const psychometric::PsychometricParameters& shape,
                                     const FittedParameters& fitted) {
  return fitted_function(shape, psychometric::curve_of(shape), fitted);
}

PsychometricFunction fitted_function(const psychometric::PsychometricParameters& shape,
                                     const psychometric::SigmoidCurve& curve,
                                     const FittedParameters& fitted) {
  psychometric::PsychometricParameters parameters = shape;
  parameters.width = fitted.width;
  parameters.lapse = fitted.lapse;
  parameters.guess = fitted.guess;
  return {parameters, curve, fitted.threshold};
}

void check_task(Task task, const psychometric::PsychometricParameters& shape) {
  if (task == Task::kForcedChoice && !(shape.guess > 0.0 && shape.guess < 1.0)) {
    throw std::invalid_argument(
        "guess of a forced choice must lie inside (0, 1): 1 / alternatives");
  }
}

}  // namespace haptrial::analysis
