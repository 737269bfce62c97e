#pragma once

// What a Bvh is made of; between bvh.cpp, its builder and the kernels.

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <vector>

#include "core/geometry/bvh.h"

namespace haptrial::geometry {

/// Coordinates of the hierarchy: centred on the mesh and scaled by a power of two, so that the mesh
/// lies within ±1 and single precision serves every mesh alike.
struct Frame {
  Eigen::Vector3d centre{Eigen::Vector3d::Zero()};
  double scale{1.0};

  Eigen::Vector3d to_frame(const Eigen::Vector3d& p) const { return (p - centre) * scale; }
};

inline constexpr int kWidth = 16;
inline constexpr int kMaxDepth = 96;  // of nodes, whatever the mesh

/// Boxes of up to sixteen children, rounded to nearest; an empty slot has low = infinity.
struct alignas(64) Node {
  float low[3][kWidth];
  float high[3][kWidth];
  std::int32_t child[kWidth];  // a node, or ~slot of a triangle
};

/// A triangle in single precision for the search. Its longest edge lies along x, the opposite
/// corner at x = 0, y > 0, and z is along the normal: each row turns (p, 1) into one coordinate.
/// The altitude divides it into two right triangles with legs `leg` along x and a hypotenuse of
/// `length` in the direction (-dx, dy). (docs/algorithms/bounding-volume-hierarchy.md)
struct alignas(16) FlatTriangle {
  float row[3][4];
  struct Half {
    float leg, dx, dy, length;
  } half[2];  // x < 0, x >= 0
};

using Corners = std::array<Eigen::Vector3d, 3>;

/// Dipoles of a node's children, in frame coordinates: the sum of the triangles' area vectors, the
/// centre where it acts, and the farthest that a triangle of the child reaches from there.
struct alignas(64) Dipoles {
  float centre[3][kWidth];
  float area[3][kWidth];
  float radius[kWidth];
};

namespace kernel {
struct Kernels;
}

struct Bvh::Data {
  const kernel::Kernels* kernels{nullptr};
  Frame frame;
  std::vector<Node> nodes;          // the root first; none: no triangles
  std::vector<FlatTriangle> flat;   // (slots), in the order of the tree
  std::vector<Corners> corners;     // (slots) as given [m]
  std::vector<std::int32_t> ids;    // (slots) the triangle of a slot
  std::vector<std::int32_t> slots;  // (triangles) the slot of a triangle

  const std::vector<Dipoles>& dipoles() const;  // (nodes), made when first asked for

 private:
  mutable std::once_flag dipoles_made_;
  mutable std::vector<Dipoles> dipoles_;
};

/// @param threads  >= 1
void build_hierarchy(const Mesh& mesh, int threads, Bvh::Data& data);

}  // namespace haptrial::geometry
