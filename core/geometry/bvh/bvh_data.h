#pragma once

// Arrays of a Bvh; between bvh.cpp, its builder and the kernels.

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "core/geometry/mesh/closest_point.h"
#include "core/geometry/mesh/mesh.h"

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

/// Boxes of up to sixteen children along the axes, rounded to nearest; an empty place has low =
/// infinity. The full ones come first.
struct alignas(64) Boxes {
  float low[3][kWidth];
  float high[3][kWidth];
};

/// The same children in boxes turned to fit, which surfaces fill far better: each row turns (p, 1)
/// into one coordinate along the box, 0 in its middle. An empty place is infinitely far.
struct alignas(64) TurnedBoxes {
  float row[3][4][kWidth];
  float half[3][kWidth];
};

struct alignas(64) Node {
  TurnedBoxes turned;
  Boxes boxes;
  std::int32_t child[kWidth];  // a node, or ~leaf
};

/// Up to sixteen triangles in single precision for the search. The longest edge of each lies along
/// x, the opposite corner at x = 0, y > 0, and z is along the normal: each row turns (p, 1) into
/// one coordinate. The altitude divides it into two right triangles (0: x < 0) with legs `leg`
/// along x and a hypotenuse of `length` in the direction (-dx, dy) from the longest edge.
/// (docs/algorithms/bounding-volume-hierarchy.md)
struct alignas(64) Leaf {
  float row[3][4][kWidth];
  float leg[2][kWidth], dx[2][kWidth], dy[2][kWidth], length[2][kWidth];
};

/// An array whose elements start unset: a builder writes each of them once.
template <class T>
class Unset {
 public:
  Unset() = default;
  explicit Unset(std::size_t size)
      : data_(std::make_unique_for_overwrite<T[]>(size)), size_(size) {}

  std::size_t size() const noexcept { return size_; }
  T* data() noexcept { return data_.get(); }
  T& operator[](std::size_t i) noexcept { return data_[i]; }
  const T& operator[](std::size_t i) const noexcept { return data_[i]; }
  const T* begin() const noexcept { return data_.get(); }
  const T* end() const noexcept { return data_.get() + size_; }

 private:
  std::unique_ptr<T[]> data_;
  std::size_t size_{0};
};

/// Dipoles of a node's children, in frame coordinates: the sum of the triangles' area vectors, the
/// centre where it acts, the farthest that a triangle of the child reaches from there, and the sum
/// of the triangles' areas.
struct alignas(64) Dipoles {
  float centre[3][kWidth];
  float vector[3][kWidth];
  float radius[kWidth];
  float area[kWidth];
};

namespace kernel {
struct Kernels;
}

struct BvhData {
  const kernel::Kernels* kernels{nullptr};
  Frame frame;
  std::vector<Node> nodes;    // the root first; none: no triangles
  Unset<Leaf> leaves;         // slot s is place s % kWidth of leaf s / kWidth
  Unset<Boxes> leaf_boxes;    // (leaves) around each triangle, for rays
  Unset<Corners> corners;     // (slots) as given [m]
  Unset<std::int32_t> ids;    // (slots) the triangle of a slot; -1: none
  Unset<std::int32_t> slots;  // (triangles) the slot of a triangle

  const std::vector<Dipoles>& dipoles() const;  // (nodes), made when first asked for

 private:
  mutable std::once_flag dipoles_made_;
  mutable std::vector<Dipoles> dipoles_;
};

/// @param threads  >= 1
void build_hierarchy(const Mesh& mesh, int threads, BvhData& data);

}  // namespace haptrial::geometry
