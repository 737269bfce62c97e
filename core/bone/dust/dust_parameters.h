#pragma once

#include <Eigen/Geometry>

#include "core/base/definition/schema_forward.h"

namespace haptrial::bone {

/// The slope of a liquid, and of dust in water.
inline constexpr double kLeastSlope = 0.05;

struct DustParameters {
  double cell{0.5e-3};           // edge of a cell > 0 [m]
  double voxel{0.5e-3};          // edge of the voxels in whose volumes dust is counted > 0 [m]
  double bulking{1.6};           // loose dust takes this many times the room of solid bone >= 1
  double fall_speed{0.15};       // > 0 [m/s]
  double slope{0.65};            // of a pile at rest, rise over run, 0.05 to 0.7
  double suction_rate{1.5e-6};   // solid volume a second > 0 [m3/s]
  double suction_reach{2.5e-3};  // from the nozzle's mouth > 0 [m]
  double water_rate{1e-8};       // solid volume a second that water at a burr takes >= 0 [m3/s]
  double water_reach{4e-3};      // of that water from the burr's surface > 0 [m]
  Eigen::Vector3d up{Eigen::Vector3d::UnitY()};  // against gravity in W, of any length but 0
  /// Dust that leaves this box in W has fallen out.
  Eigen::AlignedBox3d region{Eigen::Vector3d::Constant(-0.15), Eigen::Vector3d::Constant(0.15)};
  int max_blocks{4096};  // of 512 cells: bounds the memory, 1 to 100,000
};

/// The keys of [dust].
const Schema<DustParameters>& dust_schema();

}  // namespace haptrial::bone
