#pragma once

#include <Eigen/Geometry>

#include "core/bone/drill/burr_shape.h"
#include "core/bone/model/bone_volume.h"

namespace haptrial::bone {

/// The burr on a tick, in a frame.
struct BurrOnTick {
  Eigen::Vector3d centre{Eigen::Vector3d::Zero()};  // [m]
  double radius{0.0};                               // 0: no burr [m]
  const BurrShape* shape{nullptr};                  // null: a ball
  Eigen::Vector3d axis{Eigen::Vector3d::UnitZ()};   // from the tip along the handle, unit length

  /// Greatest distance of its points from the centre [m].
  double reach() const noexcept { return shape != nullptr ? shape->reach() : radius; }
  /// Whether it reaches into a voxel's cube; the grid is in the burr's frame. Exact for balls; to a
  /// thousandth of a voxel for other shapes.
  bool touches(const geometry::VoxelGrid& grid, const Voxel& voxel) const noexcept;
};

BurrOnTick in_frame(const Eigen::Isometry3d& X, const BurrOnTick& burr) noexcept;

}  // namespace haptrial::bone
