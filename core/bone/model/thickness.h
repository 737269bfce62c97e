#pragma once

#include <Eigen/Core>
#include <bitset>
#include <optional>
#include <span>
#include <vector>

#include "core/bone/model/bone_volume.h"

namespace haptrial::bone {

/// Criterion for bone, and how far to look for its other side.
struct ThicknessParameters {
  double limit{10e-3};                         // thicker bone counts as this thick > 0 [m]
  int reach{2};                                // of the smoothed gradient, in voxels, 1 to 4
  std::bitset<256> bone{~std::bitset<256>()};  // labels that are bone: a ray ends at others
};

/// The direction out of the bone, of unit length, from the gradient of the density smoothed by a
/// Gaussian over (2 reach + 1)^3 voxels; nothing where the neighbourhood shows no direction, as
/// inside bone or in the middle of a sheet.
std::optional<Eigen::Vector3d> outward_normal(const BoneVolume& volume, const Voxel& voxel,
                                              const ThicknessParameters& parameters = {});

/// The thickness of bone at a surface voxel [m]: the length of the straight line through its
/// centre along the normal, from where it enters the bone to where it leaves it. Nothing where the
/// voxel is not bone or has no normal.
/// Any thread, also while the servo thread drills. Does not allocate.
/// Source: Morris 2006, §3.2.9.
std::optional<double> thickness_at(const BoneVolume& volume, const Voxel& voxel,
                                   const ThicknessParameters& parameters = {});

/// The mean over those of the voxels that have a thickness, which are the surface voxels in contact
/// with a drill; nothing where none has. Visits at most `most` of them, evenly spread.
std::optional<double> mean_thickness(const BoneVolume& volume, std::span<const Voxel> voxels,
                                     const ThicknessParameters& parameters = {}, int most = 64);

/// The surface voxels whose centres lie within a sphere: bone, with an empty voxel across a face.
/// @param centre   in the bone frame B [m]
/// @param voxels   cleared and filled, in order of address in the grid
void surface_voxels_within(const BoneVolume& volume, const Eigen::Vector3d& centre, double radius,
                           std::vector<Voxel>& voxels);

}  // namespace haptrial::bone
