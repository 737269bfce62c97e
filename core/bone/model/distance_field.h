#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
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
  /// At a place, linear between the centres of voxels; nothing if one of those around it has none.
  /// @param p_B  in the model's frame [m]
  std::optional<double> linear_at(const Eigen::Vector3d& p_B) const noexcept;

 private:
  Eigen::Vector3d origin_{Eigen::Vector3d::Zero()};
  double spacing_{1.0};
  double reach_{0.0};
  Eigen::AlignedBox3i box_;             // of the voxels with a distance
  std::vector<std::uint16_t> squares_;  // of the box, x fastest [voxels^2]; 65535: beyond
};

/// The vital structures of a bone by name, each once, that have voxels; in the order of labels.
std::vector<std::string> vital_structures(const BoneModel& bone);

/// Whether each label stands for a structure of this name.
std::vector<bool> labels_named(const BoneModel& bone, const std::string& name);

/// A structure and how far from it a voxel is.
struct NearestStructure {
  std::int32_t structure{-1};  // of the fields; -1: none within their reach
  float distance{0.0F};        // between centres of voxels [m]
};

/// The nearest of several structures; of equally near ones the first. Any thread.
/// @param fields  one for each structure
NearestStructure nearest_structure(std::span<const std::shared_ptr<const DistanceField>> fields,
                                   const Voxel& voxel) noexcept;

}  // namespace haptrial::bone
