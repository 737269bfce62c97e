#pragma once

#include "core/deformable/calibration/calibration_settings.h"

namespace haptrial::deformable {

/// Finds the constants with which springs follow the reference best.
/// Source: Morris 2006, §5.3.2, §5.3.3; docs/algorithms/deformable-calibration.md.
/// @throws InputError for ranges that are not one for each parameter, or fewer than 1 evaluation;
/// std::invalid_argument as Annealing.
CalibrationResult calibrate(const CalibrationProblem& problem, const SpringParameters& parameters,
                            const CalibrationSettings& settings);

}  // namespace haptrial::deformable
