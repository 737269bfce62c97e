#include "core/geometry/flat_triangle.h"

#include <Eigen/Geometry>
#include <cmath>

namespace haptrial::geometry {
namespace {

/// Some unit vector at right angles to `u`.
Eigen::Vector3d across(const Eigen::Vector3d& u) {
  int least = 0;
  u.cwiseAbs().minCoeff(&least);
  return u.cross(Eigen::Vector3d::Unit(least)).normalized();
}

FlatTriangle::Half half_of(double leg, double height) {
  const double length = std::sqrt(leg * leg + height * height);
  const bool has_length = length > 0.0;
  return {static_cast<float>(leg), static_cast<float>(has_length ? leg / length : 1.0),
          static_cast<float>(has_length ? height / length : 0.0), static_cast<float>(length)};
}

}  // namespace

FlatTriangle flatten(const Corners& corners, const Frame& frame) {
  // The longest edge runs from a to b; differences of the corners as given lose nothing.
  int start = 0;
  double longest = -1.0;
  for (int i = 0; i < 3; ++i) {
    const double length = (corners[(i + 1) % 3] - corners[i]).squaredNorm();
    if (length > longest) {
      longest = length;
      start = i;
    }
  }
  const Eigen::Vector3d& a = corners[start];
  const Eigen::Vector3d ab = (corners[(start + 1) % 3] - a) * frame.scale;
  const Eigen::Vector3d ac = (corners[(start + 2) % 3] - a) * frame.scale;
  const double base = ab.norm();
  const Eigen::Vector3d u = base > 0.0 ? Eigen::Vector3d(ab / base) : Eigen::Vector3d::UnitX();
  const Eigen::Vector3d normal = ab.cross(ac);
  const double twice_area = normal.norm();
  // Below this the normal is rounding, and the height less than the search resolves.
  const bool flat = !(twice_area > 1e-8 * base * base);
  const Eigen::Vector3d n = flat ? across(u) : Eigen::Vector3d(normal / twice_area);
  const double height = flat ? 0.0 : twice_area / base;
  const double foot = std::min(std::max(u.dot(ac), 0.0), base);
  const Eigen::Vector3d origin = frame.to_frame(a) + foot * u;
  const Eigen::Vector3d axes[3] = {u, n.cross(u), n};
  FlatTriangle t;
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) t.row[i][k] = static_cast<float>(axes[i][k]);
    t.row[i][3] = static_cast<float>(-axes[i].dot(origin));
  }
  t.half[0] = half_of(foot, height);
  t.half[1] = half_of(base - foot, height);
  return t;
}

}  // namespace haptrial::geometry
