#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "core/geometry/mesh/mesh.h"

namespace haptrial::bone {

/// A plate with screw holes: round pads in a chain, joined by bars.
struct PlateShape {
  std::vector<Eigen::Vector2d> holes;  // at least 1, along the chain [m]
  double hole_radius{1.05e-3};         // > 0 [m]
  double pad_radius{2.5e-3};           // > hole_radius [m]
  double bar_width{2.4e-3};            // > 0, < 2 pad_radius [m]
  double thickness{1.0e-3};            // > 0 [m]
};

/// The plate from z = 0 (the side on the bone) to z = thickness, closed and without self-
/// intersections. @throws std::invalid_argument for sizes out of bounds, or holes so close or at so
/// sharp a bend that pads or bars overlap.
geometry::Mesh make_plate(const PlateShape& shape);

/// Straight, with `holes` from 2 to 20 along x, centred: `pitch` apart, the middle two `middle`.
PlateShape straight_miniplate(int holes, double pitch = 6e-3, double middle = 9e-3);
/// An L: `along` holes along x from the corner, itself one of them, and `across` along y.
PlateShape l_plate(int along = 4, int across = 2, double pitch = 6e-3);

/// Where a place of a plate comes to when the plate is bent about y, as over a round bone, and how
/// it is turned there. What lies on the bone, z = 0, keeps its length.
/// @param curvature  of the bone under the plate >= 0 [1/m]
Eigen::Isometry3d bent_at(const Eigen::Vector3d& place, double curvature);
geometry::Mesh bent(geometry::Mesh plate, double curvature);

/// An internal distractor: two footplates side by side in the plane z = 0, `gap` apart along x, and
/// a rod with its housing over them: three closed meshes that overlap. @param gap  > 0 [m]
geometry::Mesh make_distractor(double gap = 4e-3);

}  // namespace haptrial::bone
