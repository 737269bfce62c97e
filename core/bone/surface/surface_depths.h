#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/bone/model/bone_model.h"
#include "core/bone/model/bone_volume.h"

namespace haptrial::bone {

/// Which structure lies nearest to a voxel, and how far away.
struct NearStructure {
  std::uint8_t label{0};  // 0: none within reach
  double distance{0.0};   // between the voxels' centres [m]
};

/// The nearest structure that shows through thin bone, for every voxel. Made once from the bone as
/// it was before anything was removed, and never changed: any thread. What is left of them while
/// bone is removed: NearStructures. Source: Morris 2006, §3.1 (structures become visible as the
/// bone over them thins).
class StructureDepths {
 public:
  /// @param shows  by label: whether it shows through; shorter than the labels: the rest does not
  /// @param reach  how far to look, up to 250 voxels [m]
  /// @throws std::invalid_argument where the model does not fit together or reach < 0.
  StructureDepths(const BoneModel& model, const std::vector<bool>& shows, double reach = 0.003);

  /// The nearest structure; none outside the grid, nor in bricks (BoneVolume) in which the model
  /// has nothing.
  NearStructure at(const Voxel& voxel) const noexcept;
  bool shows(std::uint8_t label) const noexcept { return label < shows_.size() && shows_[label]; }
  double reach_in_voxels() const noexcept { return reach_; }
  std::size_t voxels() const noexcept { return voxels_; }  // of the model that show

 private:
  std::size_t table_index(const Voxel& voxel) const noexcept;
  static std::size_t entry_index(std::int32_t brick, const Voxel& voxel) noexcept;

  geometry::VoxelGrid grid_;
  std::vector<bool> shows_;  // by label
  double reach_{0.0};        // [voxels]
  std::size_t voxels_{0};
  std::array<std::int32_t, 3> table_size_{};  // in bricks of 8 x 8 x 8 voxels
  std::vector<std::int32_t> table_;           // number of a brick; 0: nothing within reach there
  std::vector<std::uint8_t> labels_;          // 512 to a brick; 0: nothing within reach
  std::vector<std::uint16_t> squares_;        // likewise: squared distances in voxels
};

/// Every label but 0 and those of bone itself: structures whose name is "bone" or ends in " bone".
std::vector<bool> all_but_bone(std::span<const Structure> structures);

}  // namespace haptrial::bone
