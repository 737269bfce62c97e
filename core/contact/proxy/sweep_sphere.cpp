#include <algorithm>
#include <cmath>

#include "core/contact/proxy/sweep.h"
#include "core/geometry/triangle/triangle_distance.h"

namespace haptrial::contact {
namespace {

using Eigen::Vector3d;
using geometry::TrianglePart;

/// The nearest point of a triangle and the direction away from it.
struct Away {
  double distance;
  Vector3d point;
  Vector3d normal;
  bool curved;
};

Away away_from(const geometry::Corners& c, const Vector3d& normal, const Vector3d& x) {
  const geometry::ClosestPoint nearest = geometry::closest_on_triangle(x, c[0], c[1], c[2]);
  Away away;
  away.distance = std::sqrt(nearest.distance_squared);
  away.point = nearest.point;
  away.curved = nearest.part != TrianglePart::kFace;
  if (away.distance > 0.0) {
    away.normal = (x - nearest.point) / away.distance;
  } else {
    away.normal = normal;
  }
  if (!away.curved) {
    const double height = normal.dot(x - c[0]);
    const Vector3d facing = height >= 0.0 ? normal : -normal;
    if (away.normal.dot(facing) > 0.99) {  // else the triangle is too thin to have a normal
      away.normal = facing;
      away.point = c[0];
      away.distance = std::abs(height);
    }
  }
  return away;
}

}  // namespace

bool sweep_sphere(const Sweep& sweep, const geometry::Corners& c, const Vector3d& normal,
                  std::int32_t slot, double end, SweepHit& hit, SphereGap& gap) noexcept {
  const double h = sweep.skin.thickness;
  const double limit = sweep.radius + h;
  const double rest = sweep.radius + sweep.skin.rest();
  constexpr int kMostSteps = 40;
  double t = 0.0;
  Away away = away_from(c, normal, sweep.from);
  gap = {away.distance, away.normal};
  for (int step = 0;; ++step) {
    const double rate = away.normal.dot(sweep.move);
    if (rate >= 0.0) {
      return false;  // convex: it only recedes from here on
    }
    const double left = away.distance - limit;
    if (left <= 0.25 * h && away.distance + rate * (end - t) >= sweep.radius + 0.5 * h) {
      return false;  // along the surface, to rounding
    }
    if (left <= 0.25 * h || step == kMostSteps) {
      hit.t = std::clamp(t - (rest - away.distance) / -rate, 0.0, t);
      hit.plane = {away.normal, away.point, rest, slot, away.curved};
      return true;
    }
    t += left / -rate;
    if (t >= end) {
      return false;
    }
    away = away_from(c, normal, sweep.from + t * sweep.move);
  }
}

}  // namespace haptrial::contact
