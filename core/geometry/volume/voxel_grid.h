#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/geometry/mesh/mesh_size.h"

namespace haptrial::geometry {

/// Cubic voxels along the axes. Voxel (i, j, k) has its centre at origin + spacing (i, j, k); in
/// arrays i runs fastest: index = i + size[0] (j + size[1] k).
struct VoxelGrid {
  std::array<std::int32_t, 3> size{0, 0, 0};        // voxels along x, y, z
  Eigen::Vector3d origin{Eigen::Vector3d::Zero()};  // centre of voxel (0, 0, 0) [m]
  double spacing{1.0};                              // edge of a voxel > 0 [m]

  std::size_t count() const {
    return static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]) *
           static_cast<std::size_t>(size[2]);
  }
  std::size_t index(std::int32_t i, std::int32_t j, std::int32_t k) const {
    const auto row = static_cast<std::size_t>(size[1]) * static_cast<std::size_t>(k) +
                     static_cast<std::size_t>(j);
    return static_cast<std::size_t>(size[0]) * row + static_cast<std::size_t>(i);
  }
  /// The voxel of an index.
  Eigen::Vector3i voxel(std::size_t index) const {
    const auto nx = static_cast<std::size_t>(size[0]);
    const auto ny = static_cast<std::size_t>(size[1]);
    return {static_cast<std::int32_t>(index % nx), static_cast<std::int32_t>(index / nx % ny),
            static_cast<std::int32_t>(index / nx / ny)};
  }
  std::size_t index(const Eigen::Vector3i& voxel) const {
    return index(voxel.x(), voxel.y(), voxel.z());
  }
  bool contains(const Eigen::Vector3i& voxel) const {
    return (voxel.array() >= 0).all() && voxel.x() < size[0] && voxel.y() < size[1] &&
           voxel.z() < size[2];
  }
  /// The voxel at the far corner.
  Eigen::Vector3i last() const { return {size[0] - 1, size[1] - 1, size[2] - 1}; }
  /// A centre's coordinate along an axis [m]. Everything that asks where a voxel is asks here: its
  /// rounding decides exact tests.
  double coordinate(int axis, std::int32_t i) const { return origin[axis] + spacing * i; }
  Eigen::Vector3d centre(std::int32_t i, std::int32_t j, std::int32_t k) const {
    return {coordinate(0, i), coordinate(1, j), coordinate(2, k)};
  }
  Eigen::Vector3d centre(const Eigen::Vector3i& voxel) const {
    return centre(voxel.x(), voxel.y(), voxel.z());
  }
  /// The voxel whose centre is nearest to a place, also beyond the grid.
  Eigen::Vector3i nearest(const Eigen::Vector3d& place) const {
    return ((place - origin) / spacing).array().round().cast<std::int32_t>();
  }
};

/// Calls visit(voxel, index) for each voxel of a grid, in the order of the indices.
template <class Visit>
void visit_voxels(const VoxelGrid& grid, const Visit& visit) {
  std::size_t index = 0;
  for (std::int32_t k = 0; k < grid.size[2]; ++k) {
    for (std::int32_t j = 0; j < grid.size[1]; ++j) {
      for (std::int32_t i = 0; i < grid.size[0]; ++i, ++index) {
        visit(Eigen::Vector3i(i, j, k), index);
      }
    }
  }
}

/// Position of a voxel relative to a solid, by its centre.
enum class VoxelLabel : std::uint8_t {
  kOutside = 0,
  kInside = 1,
  kBorder = 2,  // outside, with an inside voxel across one of its faces
};

/// A labelled grid.
struct VoxelSolid {
  VoxelGrid grid;
  std::vector<VoxelLabel> labels;  // grid.count()
};

/// The grid with `resolution` voxels along the longest side of `box`, which its outermost voxels
/// touch there; the other sides are covered and centred. `margin` more voxels lie on every side.
/// Source: Morris 2006, §5.2.2 (isotropic voxels, set by the long axis).
/// @throws InputError when the box has no volume to speak of (a side that is not finite, or all
/// zero), voxels would be too small for doubles that far from the origin, or resolution is not from
/// 1 to 20,000.
VoxelGrid make_grid(const Eigen::AlignedBox3d& box, int resolution, int margin = 0);

}  // namespace haptrial::geometry
