#pragma once

#include <cstddef>
#include <cstdint>

#include "core/geometry/mesh/mesh.h"

namespace haptrial::geometry {

/// Each step alone. They change the mesh in place and say how much they did; what stays keeps its
/// order.

/// Makes one vertex of those that lie together: in the order of their numbers each vertex becomes
/// the first kept one within `tolerance`, or is kept. So no vertex moves by more than `tolerance`,
/// and the kept ones lie farther apart. @param tolerance  [m]; 0: equal coordinates only
/// @returns how many became another.
std::size_t weld(Mesh& mesh, double tolerance);

/// Gives triangles without area an end: those with a repeated corner go; of one whose three corners
/// are in line, its longest side is turned to the other diagonal of the pair it forms with its
/// neighbour, which keeps a closed mesh closed.
/// @returns how many triangles went or turned; flat ones without such a neighbour stay.
std::size_t remove_degenerate(Mesh& mesh);

/// Keeps the first of the triangles with the same three corners, in any order.
std::size_t remove_duplicates(Mesh& mesh);

std::size_t remove_unreferenced(Mesh& mesh);

/// Turns triangles so that neighbours agree; closed components then look outwards, or inwards where
/// they bound a cavity (inside an odd number of others), open ones outwards seen from their middle.
/// One-sided components stay as they are. @returns how many triangles turned.
std::size_t orient(Mesh& mesh);

/// Where the faces of the closed components of an oriented mesh look, cavities left out: all of
/// them outwards, all inwards as those of a room, some this way and some that, or neither, where
/// each face has one that looks the other way and nothing is enclosed.
enum class Facing : std::uint8_t { kOutwards, kInwards, kMixed, kNeither };
Facing facing(const Mesh& mesh);

struct RepairOptions {
  double weld_tolerance{0.0};  // >= 0 [m]
};

struct RepairReport {
  std::size_t welded_vertices{0};
  std::size_t degenerate_triangles{0};  // went or turned
  std::size_t duplicate_triangles{0};
  std::size_t unreferenced_vertices{0};
  std::size_t turned_triangles{0};
};

/// All steps in the order above. @throws InputError when no triangle is left;
/// std::invalid_argument for a tolerance that is negative or not finite.
RepairReport repair(Mesh& mesh, const RepairOptions& options = {});

}  // namespace haptrial::geometry
