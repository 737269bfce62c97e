#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "core/bone/model/bone_model.h"
#include "core/bone/model/distance_field.h"
#include "core/bone/nerve/nerve_setup.h"

namespace haptrial::nerve {

/// How far a place in a bone is from each watched nerve, as the bone was made: drilling a nerve
/// away does not move it, and a piece that is carried off leaves it where it was. Immutable: any
/// thread; distances() neither allocates nor locks.
class NerveDistances {
 public:
  static constexpr double kReach = 8e-3;               // up to which structures are followed [m]
  static constexpr float kFar = 1.0f;                  // beyond it [m]
  using Distances = std::array<float, kMostChannels>;  // by nerve [m]

  /// @throws InputError for a structure that the bone has not, and a curve that leaves its grid
  NerveDistances(const bone::BoneModel& model, const std::vector<WatchedNerve>& nerves);

  /// Distances from a place to the nerves' surfaces; not above 0 inside. @param p_B  in the bone's
  /// frame [m]
  Distances at(const Eigen::Vector3d& p_B) const noexcept;

 private:
  float to_structure(const bone::DistanceField& field, const Eigen::Vector3d& p_B) const noexcept;

  Eigen::Vector3d low_, high_;  // centres of the outermost voxels [m]
  double spacing_;              // of the bone's voxels [m]
  std::vector<WatchedNerve> nerves_;
  std::vector<std::optional<bone::DistanceField>> fields_;  // by nerve; none of a curve
};

}  // namespace haptrial::nerve
