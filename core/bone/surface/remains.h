#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/bone/model/bone_volume.h"
#include "core/bone/model/occupancy.h"

namespace haptrial::bone {

/// How much of each voxel is left in a volume that is being removed, as one reader knows it.
/// Counted in sixteenths of what the voxel had at first, so that sums do not depend on their order.
/// One thread.
class RemainingFraction {
 public:
  static constexpr int kWhole = 16;

  /// Reads bricks in which something has changed, always of the same volume.
  /// @param occupancy  of the volume, as it was read just before: what holds bone
  /// @param bricks  above 0
  /// @param changed  voxels that hold bone and whose share has changed are appended; may be null
  void follow(const BoneVolume& volume, const Occupancy& occupancy,
              std::span<const std::int32_t> bricks, std::vector<Voxel>* changed);

  /// The shares of eight voxels along x, at y and z in their brick: four bits each, one less than
  /// the share. Bits of a voxel without bone mean nothing.
  std::uint32_t row(std::int32_t brick, int y, int z) const noexcept {
    return all_whole(brick) ? kWholeRow
                            : (*bricks_[static_cast<std::size_t>(brick)])[static_cast<std::size_t>(
                                  y + BoneVolume::kEdge * z)];
  }
  /// Whether each voxel of a brick that holds bone has all that it had.
  bool all_whole(std::int32_t brick) const noexcept {
    const auto at = static_cast<std::size_t>(brick);
    return at >= bricks_.size() || bricks_[at] == nullptr;
  }
  /// Bit x: whether more than half is left of a voxel that holds bone. @param row  as row() gives
  /// it
  static std::uint32_t more_than_half(std::uint32_t row) noexcept {
    std::uint32_t bits = 0;
    for (int x = 0; x < BoneVolume::kEdge; ++x) {
      bits |= (row >> (4 * x + 3) & 1U) << x;
    }
    return bits;
  }

 private:
  static constexpr std::uint32_t kWholeRow = 0xFFFFFFFFU;
  static constexpr std::size_t kRows =
      static_cast<std::size_t>(BoneVolume::kEdge) * BoneVolume::kEdge;
  using Brick = std::array<std::uint32_t, kRows>;

  std::vector<std::unique_ptr<Brick>> bricks_;  // by number; null: nothing but whole voxels
};

}  // namespace haptrial::bone
