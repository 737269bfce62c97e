#pragma once

#include <Eigen/Geometry>

#include "core/base/tool_state.h"
#include "core/geometry/mesh/mesh.h"

namespace haptrial::render {

/// Meshes of tools in the tool frame T, whose origin is the burr's centre or the tube's opening and
/// whose z axis runs along the handle.
geometry::Mesh burr_mesh(double diameter, double shaft_diameter, double length);
geometry::Mesh suction_mesh(double inner_diameter, double outer_diameter, double length);
/// A rectangle in the plane z = 0 around the origin, seen from both sides.
geometry::Mesh plane_mesh(double width, double height);
/// From T to W.
Eigen::Isometry3d pose_of(const ToolState& tool);

}  // namespace haptrial::render
