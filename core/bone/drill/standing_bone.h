#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/bone/model/bone_model.h"
#include "core/bone/model/bone_volume.h"

namespace haptrial::bone {

/// Which voxels of a bone still stand while a record of its drilling is gone through. One thread.
class StandingBone {
 public:
  /// All of the bone. @throws std::invalid_argument where the model does not fit together.
  explicit StandingBone(std::shared_ptr<const BoneModel> bone);

  const BoneModel& bone() const noexcept { return *bone_; }
  const geometry::VoxelGrid& grid() const noexcept { return bone_->grid; }
  bool inside(const Voxel& voxel) const noexcept;
  /// Whether a voxel inside the grid stands.
  bool holds(const Voxel& voxel) const noexcept {
    const std::size_t at = grid().index(voxel.x(), voxel.y(), voxel.z());
    return ((bits_[at / 64] >> (at % 64)) & 1U) != 0;
  }
  /// @returns false when there was nothing, or the voxel is outside the grid
  bool take(const Voxel& voxel) noexcept;
  /// Takes a voxel and all that hangs together with it through faces.
  /// @param taken  its voxels are appended; may be null
  void take_part(const Voxel& voxel, std::vector<Voxel>* taken = nullptr);

 private:
  std::shared_ptr<const BoneModel> bone_;
  std::vector<std::uint64_t> bits_;  // by index in the grid
};

}  // namespace haptrial::bone
