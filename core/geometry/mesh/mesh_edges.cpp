#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "core/geometry/mesh/mesh_edges.h"

namespace haptrial::geometry {
namespace {

struct SideTo {
  std::int32_t high;  // the edge's vertex with the higher number
  Side side;
};

}  // namespace

EdgeTable::EdgeTable(const Mesh& mesh) {
  const auto each_side = [&](auto&& take) {
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const Triangle& corners = mesh.triangles[t];
      if (!has_repeated_corner(corners)) {
        for (int c = 0; c < 3; ++c) {
          const auto [low, high] = std::minmax(corners[c], corners[(c + 1) % 3]);
          take(low, SideTo{high, static_cast<Side>(3 * t + c)});
        }
      }
    }
  };
  std::vector<std::uint32_t> begin(mesh.vertices.size() + 2, 0);  // of a low vertex's sides
  each_side([&](std::int32_t low, const SideTo&) { ++begin[low + 2]; });
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<SideTo> by_low(begin.back());
  each_side([&](std::int32_t low, const SideTo& side) { by_low[begin[low + 1]++] = side; });
  sides_.reserve(by_low.size());
  for (std::size_t low = 0; low < mesh.vertices.size(); ++low) {
    const auto from = by_low.begin() + begin[low];
    const auto to = by_low.begin() + begin[low + 1];
    std::sort(from, to, [](const SideTo& a, const SideTo& b) {
      return std::pair(a.high, a.side) < std::pair(b.high, b.side);
    });
    for (auto at = from; at != to; ++at) {
      if (at == from || at->high != (at - 1)->high) {
        first_.push_back(static_cast<std::uint32_t>(sides_.size()));
      }
      sides_.push_back(at->side);
    }
  }
  first_.push_back(static_cast<std::uint32_t>(sides_.size()));
}

namespace {

/// The triangles across each side whose edge has just one other, with whether they agree.
std::vector<std::uint32_t> neighbours(const Mesh& mesh, const EdgeTable& edges) {
  std::vector<Side> across(3 * mesh.triangles.size(), std::numeric_limits<Side>::max());
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto sides = edges.sides(e);
    if (sides.size() == 2) {
      across[sides[0]] = sides[1];
      across[sides[1]] = sides[0];
    }
  }
  return across;
}

}  // namespace

Orientation orientation(const Mesh& mesh, const EdgeTable& edges) {
  const std::size_t count = mesh.triangles.size();
  UnionFind joined(count);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    for (const Side side : edges.sides(e)) {
      joined.unite(edges.sides(e)[0] / 3, side / 3);
    }
  }
  Orientation result;
  result.component.resize(count);
  for (std::uint32_t t = 0; t < count; ++t) {  // a root is the first of its triangles
    const std::uint32_t root = joined.root(t);
    result.component[t] = root == t ? result.components++ : result.component[root];
  }
  result.turn.assign(count, false);
  result.one_sided.assign(result.components, false);
  const std::vector<Side> across = neighbours(mesh, edges);
  std::vector<bool> reached(count, false);
  std::vector<std::uint32_t> open;
  for (std::uint32_t start = 0; start < count; ++start) {
    if (reached[start]) {
      continue;
    }
    reached[start] = true;
    open.assign(1, start);
    while (!open.empty()) {
      const std::uint32_t t = open.back();
      open.pop_back();
      for (Side side = 3 * t; side < 3 * t + 3; ++side) {
        const Side other = across[side];
        if (other == std::numeric_limits<Side>::max()) {
          continue;
        }
        const std::uint32_t next = other / 3;
        // Two triangles agree where they run along their edge in opposite directions.
        const bool turn = result.turn[t] != (start_of(mesh, side) == start_of(mesh, other));
        if (!reached[next]) {
          reached[next] = true;
          result.turn[next] = turn;
          open.push_back(next);
        } else if (result.turn[next] != turn) {
          result.one_sided[result.component[t]] = true;
        }
      }
    }
  }
  return result;
}

double doubled_area(const Mesh& mesh, const Triangle& triangle) {
  const Eigen::Vector3d& a = mesh.vertices[triangle[0]];
  const Eigen::Vector3d along = mesh.vertices[triangle[1]] - a;
  const Eigen::Vector3d across = mesh.vertices[triangle[2]] - a;
  const double area = along.cross(across).norm();
  constexpr double kRounding = 4.0 * std::numeric_limits<double>::epsilon();
  return area <= kRounding * along.norm() * across.norm() ? 0.0 : area;
}

}  // namespace haptrial::geometry
