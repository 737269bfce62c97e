#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/bone/model/bone_volume.h"

namespace haptrial::experiments {

inline constexpr double kMillimetre = 1e-3;  // the unit of the options [m]

/// All that lies within a distance of a line; a ball where both ends are the same.
struct Stroke {
  Eigen::Vector3d from;  // in B [m]
  Eigen::Vector3d to;
  double radius;  // > 0 [m]
};

/// All that lies within a distance of a plane.
struct PlaneCut {
  Eigen::Vector3d point;   // in B [m]
  Eigen::Vector3d normal;  // of unit length
  double half_width;       // > 0 [m]
};

/// "X,Y,Z,DIAMETER" or "X,Y,Z,X2,Y2,Z2,DIAMETER" [mm].
/// @param name  of the option, for the message
/// @throws InputError
Stroke parse_stroke(const char* name, const std::string& text);
/// "X,Y,Z,NX,NY,NZ,WIDTH" [mm]; the normal of any length but 0. @throws InputError
PlaneCut parse_plane_cut(const char* name, const std::string& text);

/// Leaves each voxel the share of what it had at first that lies outside: what a plane across the
/// nearest direction, as far from its centre, would leave.
/// @param spared  by label: stays; shorter than the labels: the rest does not
void carve(bone::BoneVolume& volume, const Stroke& stroke, const std::vector<bool>& spared);
void carve(bone::BoneVolume& volume, const PlaneCut& cut, const std::vector<bool>& spared);

}  // namespace haptrial::experiments
