#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/contact/sweep.h"
#include "core/geometry/mesh/triangle_distance.h"

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
  /// The edge that the point lies on, zero for a corner; nothing on a face.
  std::optional<Vector3d> edge{};
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
  const bool inside = along > 0.0 && along < square;
  away.point = inside ? Vector3d(start + along / square * edge) : along <= 0.0 ? start : end;
  away.edge = inside ? edge : Vector3d(Vector3d::Zero());
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

/// The distance above what it must not fall to, at the part `t` of a move, and how fast it changes.
struct Height {
  double t, left, rate;  // -, [m], [m]
};

/// Whether a convex function stays above zero between where it falls and where it does not.
bool stays_above(const Height& falls, const Height& after) {
  const double back = (falls.left - after.left + falls.rate * (after.t - falls.t)) /
                      (after.rate - falls.rate);  // to where the tangents meet
  return after.left + after.rate * back > 0.0;
}

/// How much more of a move brings the sphere to `limit` from the edge or corner that is nearest, or
/// where it is nearest to that: the square of the distance is a quadratic function.
double until(const Away& away, double limit, double rate, const Vector3d& move) {
  const double square = away.edge->squaredNorm(), along = away.edge->dot(move);
  const double across = move.squaredNorm() - (square > 0.0 ? along * along / square : 0.0);
  const double falls = away.distance * rate;
  const double rest = (away.distance - limit) * (away.distance + limit);
  const double root = falls * falls - across * rest;
  return root >= 0.0 ? rest / (std::sqrt(root) - falls) : -falls / across;
}

}  // namespace

bool sweep_sphere(const Sweep& sweep, const geometry::Corners& c, const Vector3d& normal,
                  const Hull& hull, double end, SweepHit& hit, Vector3d& apart) noexcept {
  const double h = sweep.skin.thickness;
  const Hull::Heights heights = hull.heights(sweep.from, sweep.move);
  const NearPart near(c, normal, hull, heights);
  const double limit = sweep.radius + h;
  const double rest = sweep.radius + sweep.skin.rest();
  constexpr int kMostSteps = 40, kSlow = 2;
  Away away = near.away(0.0, sweep.from);
  apart = away.normal;
  Height before{};
  bool leaps = true, leapt = false;
  double t = 0.0;
  for (int step = 0;; ++step) {
    const Height here{t, away.distance - limit, away.normal.dot(sweep.move)};
    if (leapt && (here.left < -h || (here.rate >= 0.0 && !stays_above(before, here)))) {
      leaps = leapt = false;  // another part of the triangle is nearer: back, and on slowly
      t = before.t + before.left / -before.rate;
    } else {
      if (here.rate >= 0.0) {
        return false;  // convex: it only recedes from here on
      }
      const bool near_enough = here.left <= 0.25 * h;
      if (near_enough && away.distance + here.rate * (end - t) >= sweep.radius + 0.5 * h) {
        return false;  // along the surface, to rounding
      }
      if (near_enough || step >= kMostSteps) {
        hit.t = std::clamp(t - (rest - away.distance) / -here.rate, 0.0, t);
        hit.plane = {away.normal, away.point, rest, hull.slot, away.curved};
        return true;
      }
      t += here.left / -here.rate;
      if (t >= end) {
        return false;
      }
      before = here;
      leapt = leaps && step >= kSlow && away.edge;
      if (leapt) {
        t = std::min(std::max(t, here.t + until(away, limit, here.rate, sweep.move)), end);
      }
    }
    away = near.away(t, sweep.from + t * sweep.move);
  }
}

}  // namespace haptrial::contact
