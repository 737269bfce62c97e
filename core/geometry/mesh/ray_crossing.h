#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <optional>

#include "core/geometry/mesh/closest_point.h"

namespace haptrial::geometry {

/// The points origin + t direction with begin <= t <= end.
struct Ray {
  Eigen::Vector3d origin;     // [m]
  Eigen::Vector3d direction;  // not zero; need not have unit length
  double begin{0.0};
  double end{std::numeric_limits<double>::infinity()};
};

struct RayHit {
  double t;
  std::int32_t triangle;
  bool entering;  // against the triangle's normal: into a solid whose triangles face outwards
};

/// Whether one line crosses triangles, without a gap or an overlap where they meet.
///
/// Coordinates are sheared so that the line runs along z through the origin (Woop et al. 2013);
/// what a corner becomes depends on the corner alone. The origin's side of each edge is then
/// decided exactly, and a line that meets an edge counts as one moved by (e, e²), e infinitely
/// small.
class RayCrossing {
 public:
  struct Crossing {
    double t;
    bool entering;
  };

  explicit RayCrossing(const Ray& ray);

  /// Point at which the whole line meets the triangle.
  std::optional<Crossing> operator()(const Corners& corners) const;

 private:
  Eigen::Vector3d origin_;
  int x_, y_, z_;
  double shear_x_, shear_y_, scale_z_;
};

}  // namespace haptrial::geometry
