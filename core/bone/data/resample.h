#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "core/bone/data/volume_source.h"
#include "core/geometry/volume/voxel_grid.h"

namespace haptrial::bone {

/// A volume whose axes run as nearly as they can along x, y and z: only exchanged and turned round,
/// no value changed.
struct UprightVolume {
  std::array<std::int32_t, 3> size{0, 0, 0};
  Eigen::Matrix3d steps;  // columns: one voxel along i, j, k, in LPS [m]; diagonal above 0
  Eigen::Vector3d origin;
  std::vector<BigArray<float>> components;  // count of voxels each
};
UprightVolume upright(SourceVolume&& source);

/// How a volume lies to the axes of the patient.
struct Pose {
  double turn{0.0};   // the angle from them to its own, as far as these are square [rad]
  double slant{0.0};  // how far two of its own are from a right angle at most [rad]
  double shape{0.0};  // how far a corner of it lies from where cubes would put it, in voxels
  double skew{0.0};   // how far from where axes at right angles would put it, in voxels
  double off{0.0};    // how far, once its axes are taken for the patient's, from its own place [m]
};
Pose pose_of(const UprightVolume& volume);

/// A grid over the volume, from its first voxel on, along its own axes where these are square
/// (`own_axes`), else along the patient's and around all of it.
geometry::VoxelGrid grid_over(const UprightVolume& volume, double spacing, bool own_axes);

/// Map from B, as grid_over() has it, to voxels of the volume, as continuous (i, j, k).
struct VoxelMap {
  Eigen::Matrix3d turn;
  Eigen::Vector3d offset;
};
VoxelMap map_to(const UprightVolume& volume, bool own_axes);

/// Grey values at the centres of a grid: windowed sinc (Lanczos, three lobes), as wide as the
/// coarser of both, so that what the new voxels cannot hold is filtered out before. Values stay in
/// the range of the volume's; beyond its outer voxels they are its lowest.
/// The same bytes on any number of threads.
BigArray<float> resample_grey(const UprightVolume& volume, const geometry::VoxelGrid& grid,
                              bool own_axes, const geometry::WorkReport& report);

/// Labels at the centres of a grid: the nearest where it is finer, else, for voxels of which at
/// least half holds something, the most frequent label there (the higher of two). 0 beyond.
std::vector<std::uint8_t> resample_labels(std::span<const std::uint8_t> labels,
                                          const UprightVolume& volume,
                                          const geometry::VoxelGrid& grid, bool own_axes,
                                          const geometry::WorkReport& report);

}  // namespace haptrial::bone
