#pragma once

#include <Eigen/Geometry>

#include "core/geometry/mesh/mesh.h"

namespace haptrial::geometry {

/// The box around the vertices that triangles use; empty where there are none.
Eigen::AlignedBox3d bounds(const Mesh& mesh);

}  // namespace haptrial::geometry
