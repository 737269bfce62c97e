#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/bone/model/bone_model.h"
#include "core/bone/model/bone_volume.h"

namespace haptrial::bone {

/// Exact Euclidean distances from voxels to a set of voxels, between centres, by lower envelopes of
/// parabolas along one axis after the other; in integers, so that nothing is rounded. Immutable:
/// any thread. Source: Felzenszwalb and Huttenlocher 2012; for what: Morris 2006, §3.5.2.
class DistanceField {
 public:
  /// Measures distances to all voxels of a model whose label is in the set, as the model was made.
  /// @param labels  by label; shorter than the labels: the rest is not in the set
  /// @param reach   how far distances are known, up to 250 voxels [m]
  /// @throws std::invalid_argument where the model does not fit together or reach is out of bounds.
  DistanceField(const BoneModel& model, const std::vector<bool>& labels, double reach);

  bool empty() const noexcept { return box_.isEmpty(); }  // no voxel is in the set
  double reach() const noexcept { return reach_; }        // [m]
  /// [m]; nothing beyond the reach or outside the grid.
  std::optional<double> at(const Voxel& voxel) const noexcept;

 private:
  double spacing_{1.0};
  double reach_{0.0};
  Eigen::AlignedBox3i box_;             // of the voxels with a distance
  std::vector<std::uint16_t> squares_;  // of the box, x fastest [voxels^2]; 65535: beyond
};

}  // namespace haptrial::bone
