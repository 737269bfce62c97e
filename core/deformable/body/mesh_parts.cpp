#include "core/deformable/body/mesh_parts.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>

#include "core/base/error.h"

namespace haptrial::deformable {
namespace {

using geometry::Tetrahedron;

/// Corners of the face opposite each corner, outwards where the tetrahedron's volume is positive.
constexpr std::array<std::array<int, 3>, 4> kFaces{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
constexpr std::array<std::array<int, 2>, 6> kEdges{
    {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};

/// A face of one tetrahedron: in order of vertices, and as its tetrahedron turns it.
struct Side {
  Face sorted;
  Face outward;
  auto operator<=>(const Side& other) const { return sorted <=> other.sorted; }
};

std::vector<Edge> edges_of(std::span<const Tetrahedron> tetrahedra) {
  std::vector<Edge> edges;
  edges.reserve(kEdges.size() * tetrahedra.size());
  for (const Tetrahedron& t : tetrahedra) {
    for (const auto& [a, b] : kEdges) {
      const auto [low, high] = std::minmax(t[static_cast<std::size_t>(a)],  //
                                           t[static_cast<std::size_t>(b)]);
      edges.push_back({low, high});
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

std::vector<Side> sides_of(std::span<const Tetrahedron> tetrahedra) {
  std::vector<Side> sides;
  sides.reserve(kFaces.size() * tetrahedra.size());
  for (const Tetrahedron& t : tetrahedra) {
    for (const auto& corners : kFaces) {
      Face face{};
      std::transform(corners.begin(), corners.end(), face.begin(),
                     [&](int corner) { return t[static_cast<std::size_t>(corner)]; });
      Face sorted = face;
      std::sort(sorted.begin(), sorted.end());
      sides.push_back({sorted, face});
    }
  }
  std::sort(sides.begin(), sides.end());
  return sides;
}

std::int32_t root_of(std::vector<std::int32_t>& parent, std::int32_t vertex) {
  const auto up = [&](std::int32_t v) -> std::int32_t& {
    return parent[static_cast<std::size_t>(v)];
  };
  while (up(vertex) != vertex) {
    up(vertex) = up(up(vertex));
    vertex = up(vertex);
  }
  return vertex;
}

}  // namespace

MeshParts mesh_parts(std::span<const Tetrahedron> tetrahedra) {
  MeshParts parts;
  parts.edges = edges_of(tetrahedra);
  const std::vector<Side> sides = sides_of(tetrahedra);
  for (std::size_t first = 0, last = 0; first < sides.size(); first = last) {
    while (last < sides.size() && sides[last].sorted == sides[first].sorted) {
      ++last;
    }
    if (last - first > 2) {
      const Face& face = sides[first].sorted;
      throw InputError(
          fmt::format("tetrahedra: {} share the face of vertices {}, {} and {}; at most 2 may",
                      last - first, face[0], face[1], face[2]));
    }
    const bool outer = last - first == 1;
    parts.faces.push_back(outer ? sides[first].outward : sides[first].sorted);
    if (outer) {
      parts.surface.push_back(sides[first].outward);
    }
  }
  return parts;
}

double six_volumes(std::span<const Eigen::Vector3d> at, const Tetrahedron& t) {
  const auto corner = [&](std::size_t i) -> const Eigen::Vector3d& {
    return at[static_cast<std::size_t>(t[i])];
  };
  const Eigen::Vector3d a = corner(1) - corner(0), b = corner(2) - corner(0);
  return a.dot(b.cross(Eigen::Vector3d(corner(3) - corner(0))));
}

std::vector<std::int32_t> connected_parts(std::span<const Tetrahedron> tetrahedra,
                                          std::size_t vertices) {
  std::vector<std::int32_t> parent(vertices);
  std::iota(parent.begin(), parent.end(), 0);
  for (const Tetrahedron& t : tetrahedra) {
    for (std::size_t corner = 1; corner < t.size(); ++corner) {
      const std::int32_t a = root_of(parent, t[0]);
      const std::int32_t b = root_of(parent, t[corner]);
      parent[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
    }
  }
  std::vector<std::int32_t> part(vertices);
  std::int32_t parts = 0;
  for (std::size_t v = 0; v < vertices; ++v) {
    const auto root = static_cast<std::size_t>(root_of(parent, static_cast<std::int32_t>(v)));
    part[v] = root == v ? parts++ : part[root];
  }
  return part;
}

}  // namespace haptrial::deformable
