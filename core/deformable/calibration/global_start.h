#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/deformable/calibration/annealing.h"
#include "core/deformable/calibration/calibration_problem.h"
#include "core/deformable/calibration/spring_parameters.h"

namespace haptrial::deformable {

/// Logarithms of three constants, of lengths, areas and volumes [J].
using ThreeLogarithms = std::array<double, 3>;

/// Even constants, and the share of the reference's motion that they are expected to leave.
struct EvenStart {
  ThreeLogarithms logarithms;
  double left;
};

/// Ratios of areas and of volumes to lengths that are tried: common logarithms from -decades on.
struct RatioGrid {
  int decades{2};
  int per_decade{1};
};

/// Even constants from all over the ranges, the most promising first: each pair of ratios with the
/// common scale at which springs that respond like at rest follow the reference best. For small
/// displacements the scale only divides them, so that a pair costs one factorization and no search
/// for rest. Loads that move vertices say nothing of the scale; without a force it is the middle of
/// the ranges, and nothing is expected.
std::vector<EvenStart> global_starts(const CalibrationProblem& problem,
                                     const SpringParameters& parameters,
                                     std::span<const SearchRange> ranges,
                                     const RatioGrid& grid = {});

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
