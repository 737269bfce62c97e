#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/base/instruction_set.h"
#include "core/geometry/mesh/closest_point.h"
#include "core/geometry/mesh/mesh.h"
#include "core/geometry/mesh/ray_crossing.h"

namespace haptrial::geometry {

struct BvhData;

struct BvhOptions {
  int threads{0};  // that build; 0: one per processor. The hierarchy is the same for any number
  InstructionSet instruction_set{best_instruction_set()};  // all give the same answers
};

/// A bounding-volume hierarchy over the triangles of a mesh: nearest points, rays and winding
/// numbers. It keeps what it needs of the mesh. Sixteen boxes in single precision to a node, built
/// by the surface-area heuristic (docs/algorithms/bounding-volume-hierarchy.md).
///
/// All queries are const and may run on any number of threads at once. Points and rays that are not
/// finite give what a mesh without triangles gives.
class Bvh {
 public:
  /// @throws InputError naming the vertex or triangle when a coordinate is not finite or beyond
  /// ±1e100, or a triangle names a vertex that does not exist.
  explicit Bvh(const Mesh& mesh, const BvhOptions& options = {});
  ~Bvh();
  Bvh(Bvh&&) noexcept;
  Bvh& operator=(Bvh&&) noexcept;

  std::size_t triangles() const noexcept;

  /// The nearest point: the same bits as closest_on_triangle() over every triangle would give.
  /// Does not allocate.
  ClosestPoint closest(const Eigen::Vector3d& point) const noexcept;
  /// The same answer, found sooner when the triangle `hint` is near; -1 is no hint.
  ClosestPoint closest(const Eigen::Vector3d& point, std::int32_t hint) const noexcept;
  /// The same answers for many points, in any order; much faster where they are many and dense,
  /// as neighbours share a search.
  void closest(std::span<const Eigen::Vector3d> points, std::span<ClosestPoint> answers) const;

  /// Nearest point at which a ray meets the surface. A ray through an edge or corner counts as one
  /// that passes beside it by an infinitesimal step, the same for every triangle: a closed mesh is
  /// entered as often as it is left, and never crossed at a seam.
  std::optional<RayHit> nearest_hit(const Ray& ray) const;
  /// Every crossing in order of t; `hits` is cleared first, its memory used again.
  void all_hits(const Ray& ray, std::vector<RayHit>& hits) const;
  /// Whether a closed mesh holds the point: the parity of the crossings of a ray.
  bool contains(const Eigen::Vector3d& point) const;

  /// The generalized winding number: 1 inside of a closed mesh whose triangles face outwards, 0
  /// outside, and a smooth step across the holes of an open one.
  /// @param accuracy  a cluster of triangles becomes one dipole where the point is farther from
  ///     its centre than `accuracy` (above 1) times its radius; infinite: every triangle is summed.
  /// Source: Barill et al. 2018.
  double winding_number(const Eigen::Vector3d& point, double accuracy = 2.0) const;
  /// Whether the exact winding number is above one half: dipoles where the bound on their error
  /// leaves no doubt, else every triangle.
  bool winds_around(const Eigen::Vector3d& point) const;

  const BvhData& data() const noexcept { return *data_; }  // for the kernels

 private:
  std::unique_ptr<const BvhData> data_;
};

}  // namespace haptrial::geometry
