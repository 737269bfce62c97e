#pragma once

#include <cstdint>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "core/geometry/mesh/mesh.h"

/// Functions on the edges of a mesh.
namespace haptrial::geometry {

/// A side of a triangle: 3 triangle + c runs from its corner c to the next.
using Side = std::uint32_t;

inline std::size_t triangle_of(Side side) { return side / 3; }
inline std::int32_t start_of(const Mesh& mesh, Side side) {
  return mesh.triangles[side / 3][side % 3];
}
inline std::int32_t end_of(const Mesh& mesh, Side side) {
  return mesh.triangles[side / 3][(side + 1) % 3];
}
inline bool has_repeated_corner(const Triangle& t) {
  return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

/// The sides of all triangles without repeated corners, grouped by the edge that they lie on.
class EdgeTable {
 public:
  explicit EdgeTable(const Mesh& mesh);

  std::size_t size() const { return first_.size() - 1; }
  std::span<const Side> sides(std::size_t edge) const {
    return std::span(sides_).subspan(first_[edge], first_[edge + 1] - first_[edge]);
  }

 private:
  std::vector<Side> sides_;
  std::vector<std::uint32_t> first_;  // of each edge in sides_, and the end
};

/// Sets that are united pair by pair.
class UnionFind {
 public:
  explicit UnionFind(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0u);
  }
  std::uint32_t root(std::uint32_t item) {
    while (parent_[item] != item) {
      parent_[item] = parent_[parent_[item]];
      item = parent_[item];
    }
    return item;
  }
  void unite(std::uint32_t a, std::uint32_t b) {
    a = root(a);
    b = root(b);
    parent_[a < b ? b : a] = a < b ? a : b;
  }

 private:
  std::vector<std::uint32_t> parent_;
};

/// Which triangles must be turned so that those that share an edge with one other agree.
struct Orientation {
  std::vector<bool> turn;                // by triangle
  std::vector<std::uint32_t> component;  // by triangle, in the order of their first ones
  std::uint32_t components{0};           // joined through edges of any number of triangles
  std::vector<bool> one_sided;           // by component: no turning makes all agree
};
Orientation orientation(const Mesh& mesh, const EdgeTable& edges);

/// Twice the area of a triangle; 0 where its corners are in line to rounding.
double doubled_area(const Mesh& mesh, const Triangle& triangle);

}  // namespace haptrial::geometry
