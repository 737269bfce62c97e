#include "core/stimulus/stimulus.h"

#include "core/base/random.h"

namespace haptrial::stimulus {

Stimulus make_stimulus(const TrajectoryParameters& trajectory,
                       const ForcePatternParameters& force_pattern, std::uint64_t seed) {
  RandomStream path_stream(seed, "trajectory");
  RandomStream force_stream(seed, "force_pattern");
  SpatialTrajectory path = trajectory.points.empty()
                               ? SpatialTrajectory(trajectory, path_stream)
                               : SpatialTrajectory(trajectory.points, trajectory.speed);
  ForcePattern force(force_pattern, path.duration(), force_stream);
  return {std::move(path), std::move(force)};
}

}  // namespace haptrial::stimulus
