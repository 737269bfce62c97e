#pragma once

#include "core/deformable/calibration/evaluation_account.h"

namespace haptrial::deformable {

/// Descent by gradients (NLopt, L-BFGS): three even constants first, from the best of
/// global_starts() and starting_constants(). More parameters begin there and follow
///
///     error + w e0 mean((x - its kind's mean)²)
///
/// with a prior towards even constants that grows weaker in stages, w = 1, 0.1, 0.01 and 0.001; x
/// are the logarithms and e0 is the error of the even constants. A stage ends when held-out loads
/// have not been followed better for some time.
void descend(const CalibrationProblem& problem, const SpringParameters& parameters,
             const CalibrationSettings& settings, EvaluationAccount& account);

}  // namespace haptrial::deformable
