#pragma once

#include <Eigen/Geometry>

#include "core/geometry/mesh/mesh.h"

namespace haptrial::geometry {

/// The box around the vertices that triangles use; empty where there are none.
Eigen::AlignedBox3d bounds(const Mesh& mesh);

/// Volume of the region that a closed, oriented mesh bounds, negative if faces look inwards; for
/// any other mesh the integral of x·n / 3 about the middle of its box [m³].
double signed_volume(const Mesh& mesh);

}  // namespace haptrial::geometry
