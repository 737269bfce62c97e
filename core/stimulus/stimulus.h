#pragma once

#include <cstdint>

#include "core/stimulus/force_pattern.h"
#include "core/stimulus/spatial_trajectory.h"

namespace haptrial::stimulus {

/// Lesson of one block: a path for the hand and the force to be applied along it.
struct Stimulus {
  SpatialTrajectory path;
  ForcePattern force;
};

/// The stimulus of a seed: same parameters and seed, same stimulus. A recorded path is the same
/// for every seed.
Stimulus make_stimulus(const TrajectoryParameters& trajectory,
                       const ForcePatternParameters& force_pattern, std::uint64_t seed);

}  // namespace haptrial::stimulus
