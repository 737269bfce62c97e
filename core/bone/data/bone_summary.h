#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/bone/model/bone_model.h"

namespace haptrial::bone {

/// Voxels, volume and surface of one structure in a bone.
struct StructureSummary {
  std::uint8_t label;
  std::size_t voxels;
  double volume;            // [m3]
  double mean_density;      // 0 to 1
  std::size_t pieces;       // that do not touch, not even at a corner
  Eigen::AlignedBox3d box;  // around the voxels' centres, in B [m]
};

struct BoneSummary {
  std::vector<StructureSummary> structures;  // those that have voxels, by label
  std::size_t voxels{0};
  double volume{0.0};  // [m3]
  Eigen::AlignedBox3d box;
  /// Area of the outside [m2]: faces between full and empty voxels, each over |x| + |y| + |z| of
  /// the normal there, which is the area of faces on a plane of that normal for each unit of its
  /// own area. The normal is the direction away from what is full within 1.6 voxels. Within 4 % for
  /// balls and blocks of 40 voxels, however they are turned.
  double surface{0.0};
};

/// @throws std::invalid_argument as check() does. Any thread.
BoneSummary summary_of(const BoneModel& model);

}  // namespace haptrial::bone
