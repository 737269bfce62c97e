#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/big_array.h"
#include "core/deformable/springs/spring_body.h"

namespace haptrial::deformable {

/// Clusters side by side in a pack; no two of a pack share a vertex.
constexpr std::size_t kPackLanes = 8;

/// Vertices after those of the body, which fill lanes that no cluster has: a unit cube's corners.
constexpr std::size_t kFillers = 8;

/// Clusters of one shape, eight in a pack. A star is a tetrahedron with its four neighbours: eight
/// vertices, 18 edges and 16 faces; a single is one tetrahedron. An edge or face of several
/// clusters is computed with the last of them, its owner.
struct ClusterPacks {
  std::vector<std::int32_t> corners;  // (packs x vertices x 8) four times a vertex's number
  std::vector<std::uint64_t> owned;   // (packs) bit of each edge and face that some lane owns
  // Two rows of 8 for each tetrahedron of a pack, then for each owned edge and face.
  BigArray<double> constants;
};

struct SpringPacks {
  ClusterPacks stars;
  ClusterPacks singles;
  std::size_t tetrahedra{};  // in all packs, fillers among them
};

/// Stars first: every five tetrahedra in a row that are one (as tetrahedralize() makes them), then
/// what the order of tetrahedra offers; the rest are singles.
SpringPacks pack_springs(const SpringBody& body);

/// Role of an edge, face or tetrahedron in a cluster.
struct ClusterPart {
  int vertices;                // 2, 3 or 4
  std::array<int, 4> corners;  // of the cluster
  int bit;                     // in `owned`; -1 for a tetrahedron, which is always there
};

/// The parts of a star; those of a single are the first eleven.
/// Vertices 0 to 3 are the middle tetrahedron, 4 + i the neighbour's beyond the face opposite i.
constexpr std::size_t kStarParts = 6 + 1 + 4 + 4 * 7;
constexpr std::size_t kSingleParts = 6 + 1 + 4;
const std::array<ClusterPart, kStarParts>& star_parts();

}  // namespace haptrial::deformable
