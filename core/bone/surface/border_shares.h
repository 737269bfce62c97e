#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/bone/model/bone_volume.h"

namespace haptrial::bone {

/// How far a bone reaches at each voxel of its border, as it was before anything was removed.
/// Voxels alone show a flat that is not along an axis as terraces. The border is therefore taken as
/// a membrane between the last filled and the first empty voxel of each column, drawn tight:
///
///     s(face) = mean of (s + step) of the faces beside it, kept from -1/2 to 1/2 [voxels]
///
/// A face that lacks a neighbour on both sides along an axis, at an edge or where the border is
/// steep, stays in its middle; so does a sheet one voxel thick. A membrane would shrink what is
/// round, so it counts fully on slopes of up to 1 in 4 and not at all on those of 1 in 2, whose
/// terraces are so narrow that the sums around a cell level them. The share of a voxel is 1 and
/// what its faces stand out by. A pure function of a volume's labels. Made by one thread and then
/// never changed.
class BorderShares {
 public:
  static constexpr int kWhole = 16;  // a voxel whose border is in the middle
  static constexpr int kMost = 28;

  BorderShares() = default;
  explicit BorderShares(const BoneVolume& volume);

  /// Shares of the eight voxels along x at y and z in a brick, in parts of kWhole; null: all are
  /// whole.
  const std::uint8_t* row(std::int32_t brick, int y, int z) const noexcept {
    const auto at = static_cast<std::size_t>(brick);
    return at >= bricks_.size() || bricks_[at] == nullptr
               ? nullptr
               : bricks_[at]->data() + BoneVolume::kEdge * (y + BoneVolume::kEdge * z);
  }

 private:
  using Brick = std::array<std::uint8_t, BoneVolume::kBrickVoxels>;
  std::vector<std::unique_ptr<Brick>> bricks_;  // by number
};

}  // namespace haptrial::bone
