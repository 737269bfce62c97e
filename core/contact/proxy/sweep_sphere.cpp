#include <algorithm>
#include <array>
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

/// The nearest point on one edge.
/// @param normal  taken where the point lies on the edge
Away away_from_edge(const Vector3d& start, const Vector3d& end, const Vector3d& normal,
                    const Vector3d& x) {
  const Vector3d edge = end - start, from_start = x - start;
  const double along = edge.dot(from_start), square = edge.squaredNorm();
  Away away;
  away.point = along <= 0.0      ? start
               : along >= square ? end
                                 : Vector3d(start + along / square * edge);
  const Vector3d off = x - away.point;
  away.distance = off.norm();
  away.normal = away.distance > 0.0 ? Vector3d(off / away.distance) : normal;
  away.curved = true;
  return away;
}

/// A triangle that a sphere comes near to.
class NearPart {
 public:
  NearPart(const geometry::Corners& corners, const Vector3d& normal, const Hull& hull,
           const Hull::Heights& heights)
      : corners_(corners), normal_(normal), hull_(hull), heights_(heights) {}

  /// The nearest point to `x`, which lies at the part `t` of the move. The heights above the hull's
  /// planes tell which part of the triangle it is on; in case of doubt all are compared.
  Away away(double t, const Vector3d& x) const {
    constexpr double kClearly = 1e-9;  // of the distance
    const int side = height(0, t) >= height(1, t) ? 0 : 1;
    const double doubt = kClearly * std::abs(height(side, t));
    int beyond = 0;
    std::array<int, 3> edges{};
    for (int k = 0; k < 3; ++k) {
      const double out = height(Hull::kFaces + k, t);
      if (!hull_.plump || std::abs(out) <= doubt) {
        return away_from(corners_, normal_, x);
      }
      edges[beyond] = k;
      beyond += out > 0.0;
    }
    if (beyond == 0) {
      return {height(side, t), hull_.origin, hull_.out(side), false};
    }
    const Away on = edge(edges[0], x);
    const Away beside = beyond > 1 ? edge(edges[1], x) : on;
    return beside.distance < on.distance ? beside : on;
  }

 private:
  double height(int k, double t) const { return heights_.at[k] + t * heights_.gain[k]; }
  Away edge(int k, const Vector3d& x) const {
    return away_from_edge(corners_[k], corners_[(k + 1) % 3], normal_, x);
  }

  const geometry::Corners& corners_;
  const Vector3d& normal_;
  const Hull& hull_;
  const Hull::Heights& heights_;
};

}  // namespace

bool sweep_sphere(const Sweep& sweep, const geometry::Corners& c, const Vector3d& normal,
                  const Hull& hull, double end, SweepHit& hit, Vector3d& apart) noexcept {
  const double h = sweep.skin.thickness;
  const Hull::Heights heights = hull.heights(sweep.from, sweep.move);
  const NearPart near(c, normal, hull, heights);
  const double limit = sweep.radius + h;
  const double rest = sweep.radius + sweep.skin.rest();
  constexpr int kMostSteps = 40;
  double t = 0.0;
  Away away = near.away(0.0, sweep.from);
  apart = away.normal;
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
      hit.plane = {away.normal, away.point, rest, hull.slot, away.curved};
      return true;
    }
    t += left / -rate;
    if (t >= end) {
      return false;
    }
    away = near.away(t, sweep.from + t * sweep.move);
  }
}

}  // namespace haptrial::contact
