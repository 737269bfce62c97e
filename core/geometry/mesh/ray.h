#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>

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

}  // namespace haptrial::geometry
