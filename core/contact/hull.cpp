#include "core/contact/hull.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace haptrial::contact {
namespace {

using Eigen::Vector3d;

/// A plane at the farthest of the corners.
void set_plane(Hull& hull, int k, const Vector3d& out, const Vector3d& to_second,
               const Vector3d& to_third) {
  hull.x[k] = out.x();
  hull.y[k] = out.y();
  hull.z[k] = out.z();
  hull.level[k] = std::max({0.0, out.dot(to_second), out.dot(to_third)});
}

Vector3d unit_or_zero(const Vector3d& v) {
  constexpr double kLeast = 1e-140;  // of what has a square
  const double length = v.norm();
  return length > kLeast ? Vector3d(v / length) : Vector3d(Vector3d::Zero());
}

}  // namespace

void Hull::wrap(const geometry::Corners& c, const Vector3d& normal, std::int32_t of) noexcept {
  const Vector3d edges[3] = {c[1] - c[0], c[2] - c[1], c[0] - c[2]};
  const Vector3d to_second = edges[0], to_third = -edges[2];
  const auto set = [&](int k, const Vector3d& out) {
    set_plane(*this, k, out, to_second, to_third);
  };
  slot = of;
  origin = c[0];
  set(0, normal);
  set(1, -normal);
  int longest = 0;
  double most = -1.0, least = 0.0;
  for (int k = 0; k < 3; ++k) {
    const Vector3d out = unit_or_zero(edges[k].cross(normal));
    const double inwards = out.dot(edges[(k + 2) % 3]);  // a third corner that lies behind: above 0
    set(2 + k, inwards < 0.0 ? Vector3d(-out) : out);
    const double square = edges[k].squaredNorm();
    if (square > most) {
      most = square;
      least = std::abs(inwards);
      longest = k;
    }
  }
  const Vector3d along = unit_or_zero(edges[longest]);
  set(5, along);
  set(6, -along);
  set(7, Vector3d::Zero());
  constexpr double kPlump = 1e-4;  // the height over the longest edge, as a part of it
  plump = least > kPlump * std::sqrt(most) && level[0] + level[1] < 1e-9 * least;
}

Vector3d Hull::farthest(const Heights& heights) const noexcept {
  int best = 0;
  double most = -std::numeric_limits<double>::infinity();
  for (int k = 0; k < kPlanes; ++k) {
    const double least = heights.at[k] + std::min(heights.gain[k], 0.0);
    if (least > most) {
      most = least;
      best = k;
    }
  }
  return out(best);
}

}  // namespace haptrial::contact
