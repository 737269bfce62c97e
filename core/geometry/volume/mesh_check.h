#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/mesh/mesh.h"
#include "core/geometry/volume/mesh_repair.h"

namespace haptrial::geometry {

/// Properties of a mesh. Triangles that repeat a corner do not count in the figures of edges.
/// Self-intersections are not looked for.
struct MeshReport {
  std::size_t vertices{0};
  std::size_t triangles{0};
  std::size_t unreferenced_vertices{0};
  std::size_t repeated_corner_triangles{0};
  std::size_t flat_triangles{0};       // three different corners in line: no area
  std::size_t duplicate_triangles{0};  // the same corners as another, in any order

  std::size_t edges{0};
  std::size_t boundary_edges{0};        // of one triangle
  std::size_t odd_edges{0};             // of one, three or another odd number
  std::size_t nonmanifold_edges{0};     // of three or more
  std::size_t nonmanifold_vertices{0};  // where several fans of triangles touch
  std::size_t disagreeing_edges{0};     // of two that run along it in the same direction
  std::size_t boundary_loops{0};

  std::size_t components{0};  // joined through edges
  std::size_t one_sided_components{0};
  std::optional<std::size_t> genus;  // handles of all components; none where edges are not manifold

  double area{0.0};                  // [m²]
  double volume{0.0};                // signed_volume() [m³]; negative where faces look inwards
  Facing facing{Facing::kOutwards};  // of closed, oriented meshes
  Eigen::AlignedBox3d box;

  /// Every edge belongs to an even number of triangles: inside and outside differ by parity.
  bool closed{false};
  /// Neighbours run along their edges in opposite directions.
  bool oriented() const { return disagreeing_edges == 0; }
  bool manifold() const { return nonmanifold_edges == 0 && nonmanifold_vertices == 0; }
};

/// Source: Morris 2006, §5.2.2 (the surface that is to be voxelized).
MeshReport check_mesh(const Mesh& mesh);

/// The report in sentences for people, one a line.
std::vector<std::string> describe(const MeshReport& report);

}  // namespace haptrial::geometry
