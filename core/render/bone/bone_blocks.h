#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

#include "core/bone/surface/surface.h"

namespace haptrial::render {

/// The quads of a surface by the blocks of cells that they lie in, kept up to date while it
/// changes: which of them may fall into a part of the picture, and which part changed. One thread.
class BoneBlocks {
 public:
  static constexpr int kEdge = 16;  // cells

  struct Block {
    Eigen::AlignedBox3d box;          // around whatever quads it may have, in B [m]
    std::vector<std::int32_t> quads;  // in no order
  };

  /// Takes over what the surface's last update() changed.
  void follow(const bone::Surface& surface, const geometry::VoxelGrid& grid);

  std::span<const Block> blocks() const noexcept { return blocks_; }
  /// Around all quads, in B [m]; empty where there are none.
  Eigen::AlignedBox3d bounds() const;
  /// Around all that the last follow() brought, in B [m], as it was before and as it is now:
  /// outside of it the surface is the same, its colours too. Empty where nothing changed.
  Eigen::AlignedBox3d changed() const;

 private:
  struct QuadSlot {
    std::int32_t block{-1};  // -1: it is dead
    std::uint16_t at{0};     // in the block
    std::uint16_t cell{0};   // of the quad: its place in the block, x fastest
  };
  // While quads change their slots, a block has each at most twice.
  static_assert(2 * 3 * kEdge * kEdge * kEdge <= 65536);
  void begin(const geometry::VoxelGrid& grid);
  void put(std::int32_t quad, const bone::Voxel& cell);
  void remove(QuadSlot& home);
  bone::Voxel cell_of(const QuadSlot& home) const;
  Eigen::AlignedBox3d box_of(const bone::Voxel& low, const bone::Voxel& high) const;

  geometry::VoxelGrid grid_;
  bone::Voxel table_size_{0, 0, 0};  // in blocks
  std::vector<Block> blocks_;        // by place, x fastest
  std::vector<QuadSlot> homes_;      // by quad
  Eigen::AlignedBox3i changed_;      // corners in voxels
};

}  // namespace haptrial::render
