#pragma once

#include "core/psychometric/function/psychometric_function.h"
#include "core/psychometric/procedure/quest_tables.h"

namespace haptrial::psychometric {

/// A psychometric function whose parameters are sought.
struct PsiParameters {
  PsychometricParameters function;  // sigmoid, axis, share, tail, falling; and what is not sought
  std::vector<double> levels;       // that may be presented [level]
  QuestDimension threshold{"threshold", {}, {}, false};  // [level]; no values: that of `function`
  QuestDimension width{"width", {}, {}, false};          // [unit of the axis]; likewise
  QuestDimension guess{"guess", {}, {}, false};          // likewise
  QuestDimension lapse{"lapse", {}, {}, false};          // likewise
};

/// The Psi method (Kontsevich and Tyler 1999) as a case of QUEST+: one stimulus dimension, "level";
/// outcomes 0 and 1; parameters threshold, width, guess and lapse. With lapse (or any other) as a
/// nuisance, marginal Psi (Prins 2013, J. Vision 13(7):3).
/// @throws std::invalid_argument naming the parameter of the function that breaks its bound
QuestDefinition psi_definition(const PsiParameters& parameters);

}  // namespace haptrial::psychometric
