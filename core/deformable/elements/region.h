#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/base/definition/table.h"
#include "core/deformable/body/mesh_parts.h"
#include "core/geometry/volume/tetrahedralize.h"

namespace haptrial::deformable {

/// A part of a body that a file names: one of a side, a box, a ball, and the vertex nearest to a
/// place.
struct Region {
  enum class Kind { kSide, kBox, kBall, kNearest };
  Kind kind{Kind::kBox};
  int axis{0};                                      // of a side: 0, 1, 2
  bool high{false};                                 // of a side: that of the largest coordinates
  Eigen::Vector3d low{Eigen::Vector3d::Zero()};     // of a box [m]
  Eigen::Vector3d top{Eigen::Vector3d::Zero()};     // of a box [m]
  Eigen::Vector3d centre{Eigen::Vector3d::Zero()};  // of a ball; the place [m]
  double radius{};                                  // of a ball [m]
};

/// side = "+x", or low and high, or centre and radius, or nearest. Problems are noted in the table.
Region read_region(Table& table);

/// Vertices in a region, ascending. A side has those within a millionth of the body's extent.
std::vector<std::int32_t> vertices_in(const Region& region, const geometry::TetMesh& body);

/// Outer faces all of whose vertices are in a region. @param surface  of mesh_parts()
std::vector<Face> faces_in(const Region& region, const geometry::TetMesh& body,
                           const std::vector<Face>& surface);

}  // namespace haptrial::deformable
