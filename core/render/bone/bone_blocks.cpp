#include "core/render/bone/bone_blocks.h"

#include <algorithm>

#include "core/base/growth.h"

namespace haptrial::render {
namespace {

using bone::Voxel;

/// The last of the four cells of a quad along every axis; any of its triangles has two cells that
/// lie across.
Voxel cell_of_quad(const bone::Surface& surface, const bone::SurfaceTriangle& triangle) {
  const auto cell = [&](std::size_t corner) {
    return surface.cell_of(static_cast<std::int32_t>(triangle[corner]));
  };
  return cell(0).cwiseMax(cell(1)).cwiseMax(cell(2));
}

}  // namespace

void BoneBlocks::begin(const geometry::VoxelGrid& grid) {
  grid_ = grid;
  homes_.clear();
  blocks_.clear();
  for (int axis = 0; axis < 3; ++axis) {  // cells from -1 to the size less one, 1 to kEdge on
    table_size_[axis] = (grid.size[static_cast<std::size_t>(axis)] + kEdge) / kEdge;
  }
  for (int k = 0; k < table_size_.z(); ++k) {
    for (int j = 0; j < table_size_.y(); ++j) {
      for (int i = 0; i < table_size_.x(); ++i) {
        const Voxel low = kEdge * Voxel(i, j, k) - Voxel::Ones();
        blocks_.push_back({box_of(low - Voxel::Ones(), low + Voxel::Constant(kEdge)), {}});
      }
    }
  }
}

/// Cell (i, j, k) lies between the centres of voxel (i, j, k) and (i + 1, j + 1, k + 1).
Eigen::AlignedBox3d BoneBlocks::box_of(const Voxel& low, const Voxel& high) const {
  return {grid_.centre(low), grid_.centre(high)};
}

void BoneBlocks::follow(const bone::Surface& surface, const geometry::VoxelGrid& grid) {
  changed_.setEmpty();
  if (surface.rebuilt()) {
    for (QuadSlot& home : homes_) {
      remove(home);
    }
    begin(grid);
  }
  resize_slowly(homes_, std::max(homes_.size(), surface.triangles().size() / 2));
  for (const std::int32_t quad : surface.changed_quads()) {
    remove(homes_[static_cast<std::size_t>(quad)]);
    const bone::SurfaceTriangle& triangle = surface.triangles()[2 * static_cast<std::size_t>(quad)];
    if (triangle[0] != triangle[1]) {
      put(quad, cell_of_quad(surface, triangle));
    }
  }
  // All triangles at a vertex lie in the cells around its own.
  for (const std::int32_t vertex : surface.changed_vertices()) {
    const Voxel cell = surface.cell_of(vertex);
    changed_.extend(Voxel(cell - Voxel::Ones()));
    changed_.extend(Voxel(cell + Voxel::Constant(2)));
  }
}

void BoneBlocks::put(std::int32_t quad, const Voxel& cell) {
  const Voxel at = (cell + Voxel::Ones()) / kEdge;
  const Voxel within = cell + Voxel::Ones() - kEdge * at;
  const std::int32_t place = at.x() + table_size_.x() * (at.y() + table_size_.y() * at.z());
  std::vector<std::int32_t>& quads = blocks_[static_cast<std::size_t>(place)].quads;
  homes_[static_cast<std::size_t>(quad)] = {
      place, static_cast<std::uint16_t>(quads.size()),
      static_cast<std::uint16_t>(within.x() + kEdge * (within.y() + kEdge * within.z()))};
  quads.push_back(quad);
  changed_.extend(Voxel(cell - Voxel::Ones()));
  changed_.extend(Voxel(cell + Voxel::Ones()));
}

Voxel BoneBlocks::cell_of(const QuadSlot& home) const {
  const Voxel block(home.block % table_size_.x(), home.block / table_size_.x() % table_size_.y(),
                    home.block / (table_size_.x() * table_size_.y()));
  const Voxel within(home.cell % kEdge, home.cell / kEdge % kEdge, home.cell / (kEdge * kEdge));
  return kEdge * block + within - Voxel::Ones();
}

void BoneBlocks::remove(QuadSlot& home) {
  if (home.block < 0) {
    return;
  }
  const Voxel cell = cell_of(home);
  std::vector<std::int32_t>& quads = blocks_[static_cast<std::size_t>(home.block)].quads;
  const std::int32_t last = quads.back();
  quads[static_cast<std::size_t>(home.at)] = last;
  homes_[static_cast<std::size_t>(last)].at = home.at;
  quads.pop_back();
  home.block = -1;
  changed_.extend(Voxel(cell - Voxel::Ones()));
  changed_.extend(Voxel(cell + Voxel::Ones()));
}

Eigen::AlignedBox3d BoneBlocks::bounds() const {
  Eigen::AlignedBox3d all;
  for (const Block& block : blocks_) {
    if (!block.quads.empty()) {
      all.extend(block.box);
    }
  }
  return all;
}

Eigen::AlignedBox3d BoneBlocks::changed() const {
  return changed_.isEmpty() ? Eigen::AlignedBox3d() : box_of(changed_.min(), changed_.max());
}

}  // namespace haptrial::render
