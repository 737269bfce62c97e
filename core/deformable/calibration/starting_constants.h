#pragma once

#include <span>
#include <vector>

#include "core/deformable/calibration/annealing.h"
#include "core/deformable/calibration/calibration_problem.h"
#include "core/deformable/calibration/spring_parameters.h"

namespace haptrial::deformable {

/// Constants with which the springs balance the loads best if the vertices are where the reference
/// has them: forces are linear in the constants, so that this is linear least squares with
/// non-negative unknowns (by projected coordinate descent on sparse columns), and needs no statics.
/// Where no force acts and vertices are only moved, ratios alone matter: the middle of each range.
/// @param ranges  of the logarithms; constants are cut to them
/// @returns logarithms
std::vector<double> starting_constants(const CalibrationProblem& problem,
                                       const SpringParameters& parameters,
                                       std::span<const SearchRange> ranges);

}  // namespace haptrial::deformable
