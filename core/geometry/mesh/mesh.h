#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace haptrial::geometry {

using Triangle = std::array<std::int32_t, 3>;

/// An indexed triangle mesh. Vertices in [m] unless a caller says otherwise; the corners of a
/// triangle run anticlockwise seen from outside. Nothing more is promised: the mesh may be open,
/// degenerate or several pieces; check_mesh says which.
struct Mesh {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Triangle> triangles;
};

}  // namespace haptrial::geometry
