#include "core/psychometric/procedure/psi_definition.h"

#include <algorithm>

namespace haptrial::psychometric {
namespace {

QuestDimension or_fixed(QuestDimension dimension, double value) {
  if (dimension.values.empty()) {
    dimension.values = {value};
    dimension.prior.clear();
  }
  return dimension;
}

}  // namespace

QuestDefinition psi_definition(const PsiParameters& parameters) {
  const PsychometricParameters& fixed = parameters.function;
  QuestDefinition definition;
  definition.stimulus = {{"level", parameters.levels, {}, false}};
  definition.parameters = {
      or_fixed(parameters.threshold, fixed.threshold), or_fixed(parameters.width, fixed.width),
      or_fixed(parameters.guess, fixed.guess), or_fixed(parameters.lapse, fixed.lapse)};
  definition.model = [fixed, curve = curve_of(fixed)](const double* stimulus, const double* values,
                                                      double* probabilities) {
    PsychometricParameters p = fixed;
    p.width = values[1];
    p.guess = values[2];
    p.lapse = values[3];
    const double psi =
        std::min(1.0, PsychometricFunction(p, curve, p.axis.at(values[0]))(stimulus[0]));
    probabilities[0] = 1.0 - psi;
    probabilities[1] = psi;
  };
  return definition;
}

}  // namespace haptrial::psychometric
