#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/bvh/bvh.h"
#include "core/geometry/mesh/mesh.h"

namespace haptrial::contact {

/// A triangle that may be near, with a lower bound of its distance.
struct NearTriangle {
  double distance;  // no part of the triangle is nearer [m]
  std::int32_t slot;
};

/// A triangle mesh made ready to be felt. Any mesh: open, not manifold, with slivers; a triangle
/// has no inside, both of its sides are felt. Coordinates are those of the mesh (the object's
/// frame), in any unit: nothing here has a length of its own.
///
/// Triangles are known by their slot, their place in the hierarchy, so that neighbours in space are
/// neighbours in memory. All queries are const and serve any number of threads.
class ContactSurface {
 public:
  /// @param threads  that build; 0: one per processor
  /// @throws InputError naming the vertex or triangle when a coordinate is not finite or beyond
  ///         ±1e100, or a triangle names a vertex that does not exist.
  explicit ContactSurface(const geometry::Mesh& mesh, int threads = 0);

  std::size_t triangles() const noexcept { return bvh_.triangles(); }
  const geometry::Bvh& bvh() const noexcept { return bvh_; }

  /// The largest coordinate in size: what rounding errors scale with [m].
  double magnitude() const noexcept { return magnitude_; }
  /// The side of a square of two mean triangles [m].
  double typical_edge() const noexcept { return typical_edge_; }

  const geometry::Corners& corners(std::int32_t slot) const noexcept { return corners_[slot]; }
  std::int32_t triangle(std::int32_t slot) const noexcept { return ids_[slot]; }
  std::int32_t slot(std::int32_t triangle) const noexcept { return slots_[triangle]; }
  /// A unit normal. Of a triangle thinner than coordinates can tell it is that of the neighbour
  /// across its longest edge; of a triangle that is a point it is zero.
  const Eigen::Vector3d& normal(std::int32_t slot) const noexcept { return normals_[slot]; }

  /// Every triangle whose box comes within `reach` of `centre`, in no order.
  /// @returns how many there are; -1 if `found` is too short. Servo thread.
  int gather(const Eigen::Vector3d& centre, double reach,
             std::span<NearTriangle> found) const noexcept;

  /// Visits the triangles whose boxes come within `radius` of the segment from `from` to
  /// `from + move`, the nearer boxes first: visit(context, slot) returns the part of the segment
  /// that is still of interest, 0 to 1. Servo thread.
  using Visit = double (*)(void* context, std::int32_t slot);
  void along(const Eigen::Vector3d& from, const Eigen::Vector3d& move, double radius, Visit visit,
             void* context) const noexcept;

 private:
  void find_normals(const geometry::Mesh& mesh);

  geometry::Bvh bvh_;
  const geometry::Corners* corners_{nullptr};  // of the hierarchy
  const std::int32_t* ids_{nullptr};
  const std::int32_t* slots_{nullptr};
  std::vector<Eigen::Vector3d> normals_;  // by slot
  double magnitude_{0.0};
  double typical_edge_{0.0};
};

/// A unit normal of every triangle, on the side from which its corners run anticlockwise.
///
/// The corners of a triangle that is thinner than 2^-38 of `magnitude` do not tell its normal: they
/// are rounded to 2^-53 of it. Such a triangle takes the normal of the neighbour across its longest
/// edge, or, if all of those are as thin, any that is square to that edge. A triangle whose corners
/// coincide has the normal zero.
/// @param magnitude  the largest coordinate in size [m]
std::vector<Eigen::Vector3d> triangle_normals(const geometry::Mesh& mesh, double magnitude);

}  // namespace haptrial::contact
