#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/volume/tetrahedralize.h"

namespace haptrial::deformable {

using Edge = std::array<std::int32_t, 2>;  // lower vertex first
using Face = std::array<std::int32_t, 3>;

/// Edges and faces that tetrahedra share, each once, in ascending order of the vertices.
struct MeshParts {
  std::vector<Edge> edges;
  std::vector<Face> faces;    // every face; an outer one by the right hand with its normal outwards
  std::vector<Face> surface;  // the outer faces alone
};

/// Source: Morris 2006, §5.3.3 (constants by edge, face and tetrahedron).
/// @throws InputError naming a face that three tetrahedra share.
MeshParts mesh_parts(std::span<const geometry::Tetrahedron> tetrahedra);

/// Six times the volume of a tetrahedron; negative: it is inside out. @param at  of vertices [m]
double six_volumes(std::span<const Eigen::Vector3d> at, const geometry::Tetrahedron& t);

/// The part of the body, from 0, that each of `vertices` belongs to: vertices that tetrahedra
/// connect have one number. A vertex without a tetrahedron is a part of its own.
std::vector<std::int32_t> connected_parts(std::span<const geometry::Tetrahedron> tetrahedra,
                                          std::size_t vertices);

}  // namespace haptrial::deformable
