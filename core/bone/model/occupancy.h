#pragma once

#include <cstdint>
#include <vector>

#include "core/bone/model/bone_volume.h"

namespace haptrial::bone {

/// One thread's own picture of which voxels of a volume hold bone, brought up to date whenever that
/// thread likes: it compares what it knows with the bricks that have changed since. Nothing can be
/// missed and nothing overflows, however far the thread falls behind.
class Occupancy {
 public:
  /// Begins empty: the first follow() reports all of the volume.
  Occupancy() = default;

  /// Reads what has changed in the volume since the last call, always the same volume.
  /// @param changed  voxels that were filled or emptied are appended, in order of address
  /// @param bricks   bricks in which any density changed are appended; may be null
  void follow(const BoneVolume& volume, std::vector<Voxel>& changed,
              std::vector<std::int32_t>* bricks = nullptr) {
    follow(volume, &changed, bricks);
  }
  /// The same without a list of voxels, which for a whole bone takes more memory than the bone.
  void follow(const BoneVolume& volume) { follow(volume, nullptr, nullptr); }

  /// Whether the voxel with this address holds bone, as of the last follow().
  bool holds(std::int32_t address) const noexcept {
    const auto at = static_cast<std::size_t>(address);
    return at / 64 < bits_.size() && ((bits_[at / 64] >> (at % 64)) & 1U) != 0;
  }
  /// The same for the 64 voxels of a layer of z, from 0 to 7, of a brick: bit x + 8 y.
  std::uint64_t layer(std::int32_t brick, int z) const noexcept {
    const auto at = static_cast<std::size_t>(brick) * 8 + static_cast<std::size_t>(z);
    return at < bits_.size() ? bits_[at] : 0;
  }
  std::size_t count() const noexcept { return count_; }  // of voxels that hold bone

 private:
  void follow(const BoneVolume& volume, std::vector<Voxel>* changed,
              std::vector<std::int32_t>* bricks);

  std::vector<std::uint64_t> bits_;      // by address
  std::vector<std::uint32_t> versions_;  // by brick, as last read
  std::vector<bool> seen_;               // by brick
  std::size_t count_{0};
};

}  // namespace haptrial::bone
