#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/big_array.h"
#include "core/deformable/body/vertex_frames.h"

namespace haptrial::deformable {

struct NearPoint {
  double square;        // of the distance [m²]
  std::int32_t number;  // of the point
  auto operator<=>(const NearPoint&) const = default;
};

/// A kd-tree: the n points nearest to a place, nearest first; of equally near ones that with the
/// lower number.
/// Source: Morris 2006, §5.4.2.
class NearestPoints {
 public:
  explicit NearestPoints(std::vector<Eigen::Vector3d> points);

  /// @param nearest  receives `count` points, or all where there are less
  void find(const Eigen::Vector3d& place, std::size_t count, std::vector<NearPoint>& nearest) const;

 private:
  void split(std::size_t first, std::size_t last, int axis);
  void search(const Eigen::Vector3d& place, std::size_t count, std::size_t first, std::size_t last,
              int axis, std::vector<NearPoint>& nearest) const;

  std::vector<Eigen::Vector3d> points_;
  std::vector<std::int32_t> order_;  // the middle of each range divides it along x, y, z in turns
};

/// A surface of many triangles that follows a coarse body. The nearest vertices s of the body's
/// surface, each with its frame F, place each vertex r of the fine one. Their weights fall with the
/// squared distance at rest:
///
///     p(r) = Σ w_s (p(s) + F_s offset_rs),   w_s ∝ 1 / |r - s|²,   Σ w_s = 1
///
/// At rest this gives the rest surface, and rotated and translated with the body the same surface
/// rotated and translated, to rounding. A vertex that lies on one of the body's follows that alone.
/// Source: Morris 2006, §5.4.2.
class Skin {
 public:
  /// @param rest  positions of the simulation mesh (vertices) [m]
  /// @param surface  its outer faces, normals outwards (mesh_parts)
  /// @param skin  the surface's vertices at rest (skin vertices) [m]
  /// @param neighbours  that place a vertex, at least 1; all where the body's surface has less
  /// @throws InputError for less than 1 neighbour, a surface without a vertex that has a normal, or
  /// a vertex that is not finite.
  Skin(std::span<const Eigen::Vector3d> rest, std::span<const Face> surface,
       std::span<const Eigen::Vector3d> skin, int neighbours = 5);

  /// Places every vertex of the skin.
  /// @param positions  of the simulation mesh (vertices) [m]
  /// @param skin  receives (skin vertices) [m]
  /// No allocation, lock or throw (SkinTest.AnUpdateDoesNotAllocate).
  void update(std::span<const Eigen::Vector3d> positions, std::span<Eigen::Vector3d> skin) noexcept;

  std::size_t vertices() const { return vertices_; }
  std::size_t neighbours() const { return neighbours_; }  // of each vertex
  /// Frames that had no direction at the last update and stayed as they were.
  std::size_t lost_frames() const { return lost_frames_; }

 private:
  /// Weight of one frame for one vertex.
  struct Vote {
    double weight;
    std::array<double, 3> offset;  // in the frame, times the weight [m]
  };

  void bind(std::span<const Eigen::Vector3d> skin);

  VertexFrames frames_;
  std::size_t vertices_;
  std::size_t neighbours_;
  BigArray<std::int32_t> frame_;  // (skin vertices x neighbours)
  BigArray<Vote> votes_;          // the same
  std::size_t lost_frames_{0};
};

}  // namespace haptrial::deformable
