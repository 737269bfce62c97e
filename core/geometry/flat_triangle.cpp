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

void write_half(double leg, double height, int side, Leaf& leaf, int place) {
  const double length = std::sqrt(leg * leg + height * height);
  const bool has_length = length > 0.0;
  leaf.leg[side][place] = static_cast<float>(leg);
  leaf.dx[side][place] = static_cast<float>(has_length ? leg / length : 1.0);
  leaf.dy[side][place] = static_cast<float>(has_length ? height / length : 0.0);
  leaf.length[side][place] = static_cast<float>(length);
}

}  // namespace

void flatten(const Corners& corners, const Frame& frame, Leaf& leaf, int place) {
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
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) leaf.row[i][k][place] = static_cast<float>(axes[i][k]);
    leaf.row[i][3][place] = static_cast<float>(-axes[i].dot(origin));
  }
  write_half(foot, height, 0, leaf, place);
  write_half(base - foot, height, 1, leaf, place);
}

void leave_empty(Leaf& leaf, int place) {
  for (auto& row : leaf.row) {
    for (auto& values : row) values[place] = 0.0f;
  }
  leaf.row[2][3][place] = 1e30f;  // its square is infinite
  write_half(0.0, 0.0, 0, leaf, place);
  write_half(0.0, 0.0, 1, leaf, place);
}

}  // namespace haptrial::geometry
