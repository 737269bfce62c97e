#include "core/contact/arc.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/geometry/mesh/triangle_distance.h"

namespace haptrial::contact {
namespace {

using Eigen::Vector3d;
using geometry::TrianglePart;

/// A direction, or where the face of a triangle beside the edge begins if that is before it.
Vector3d before_face(const Vector3d& wanted, const Vector3d& from, const Vector3d& normal,
                     const Vector3d& to_middle) {
  if (!(wanted.dot(to_middle) > 0.0)) {
    return wanted;
  }
  return normal.dot(from) >= 0.0 ? normal : -normal;
}

/// tan(a / 2) for the angle a between two directions.
double tan_half(const Vector3d& a, const Vector3d& b) { return (a - b).norm() / (a + b).norm(); }

/// The sliding way of an arc, by how much of tan(a / 2) is left: from 1 on towards 0.
class Slide {
 public:
  Slide(const Arc& arc, double friction)
      : arc_(arc), friction_(friction), start_(tan_half(arc.from, arc.wanted)) {}

  /// Pull along the arc; not above zero if the sphere rests in the friction cone or nothing pushes
  /// it any more.
  double pull(double left) const {
    const double t = start_ * left, sine = 2.0 * t / (1.0 + t * t);
    const double cosine = (1.0 - t * t) / (1.0 + t * t);
    const double rest = std::pow(left, arc_.distance / arc_.depth) * arc_.along.norm();
    const double push = arc_.distance - arc_.depth * cosine;
    return std::min(std::hypot(arc_.depth * sine, rest) - friction_ * push, push);
  }
  /// Angle at which the move first rests or leaves; 0: nowhere.
  double end() const {
    constexpr double kShorter = 0.75, kNothing = 1e-9;
    double sliding = 1.0, resting = 1.0;
    while (pull(resting) > 0.0) {
      sliding = resting;
      resting *= kShorter;
      if (resting < kNothing) {
        return 0.0;
      }
    }
    return sliding > resting ? between(sliding, resting) : 1.0;
  }
  Vector3d direction(double left) const {
    const double t = start_ * left;
    const Vector3d aside = arc_.from - arc_.wanted * arc_.wanted.dot(arc_.from);
    return ((1.0 - t * t) * arc_.wanted + 2.0 * t * aside.stableNormalized()).normalized();
  }

 private:
  /// The zero of the pull, by false position (Illinois).
  double between(double a, double b) const {
    constexpr int kMost = 60;
    double at_a = pull(a), at_b = pull(b);
    for (int i = 0; i < kMost && std::abs(a - b) > 1e-15 * a && at_b != 0.0; ++i) {
      const double x = b - at_b * (b - a) / (at_b - at_a);
      const double at_x = pull(x);
      if ((at_x > 0.0) != (at_b > 0.0)) {
        a = b;
        at_a = at_b;
      } else {
        at_a *= 0.5;
      }
      b = x;
      at_b = at_x;
    }
    return b;
  }

  const Arc& arc_;
  double friction_, start_;
};

/// The target; for a turn by more than a right angle its middle, as the tangents would meet far
/// off.
Vector3d at_once(const Vector3d& from, const Vector3d& to) {
  return from.dot(to) < 0.0 ? (from + to).normalized() : to;
}

}  // namespace

double Arc::slid(const Vector3d& to) const noexcept {
  return rubbed ? 1.0 - std::pow(tan_half(to, wanted) / tan_half(from, wanted), distance / depth)
                : 1.0;
}

Vector3d Arc::across(const Vector3d& normal) const noexcept {
  const double length = along.norm();
  Vector3d to = normal;
  if (length > 0.0) {
    to -= along * (along.dot(normal) / (length * length));
  }
  return to.normalized();
}

std::optional<Arc> arc_round(const ContactSurface& surface, const ContactPlane& plane,
                             const Vector3d& at, const Vector3d& goal, double friction,
                             double least) noexcept {
  const geometry::Corners& c = surface.corners(plane.slot);
  const geometry::ClosestPoint nearest = geometry::closest_on_triangle(at, c[0], c[1], c[2]);
  if (nearest.part == TrianglePart::kFace ||
      std::sqrt(nearest.distance_squared) > plane.level + 2.0 * least) {
    return std::nullopt;
  }
  Vector3d to_goal = goal - nearest.point, along = Vector3d::Zero(), edge = Vector3d::Zero();
  const bool round_edge = nearest.part <= TrianglePart::kEdge2;
  if (round_edge) {
    const int k = static_cast<int>(nearest.part) - static_cast<int>(TrianglePart::kEdge0);
    edge = (c[(k + 1) % 3] - c[k]).stableNormalized();
    along = edge * edge.dot(to_goal);
    to_goal -= along;
  }
  const double depth = to_goal.norm();
  const Vector3d wanted = to_goal / depth;
  const double towards = plane.normal.dot(wanted);
  constexpr double kBehind = 0.05, kOpposite = -1.0 + 1e-9;
  if (!(depth > least) || !(towards > (friction > 0.0 ? kOpposite : kBehind))) {
    return std::nullopt;
  }
  Arc arc{nearest.point, along, plane.normal, wanted, wanted, plane.level, depth, friction > 0.0};
  if (arc.rubbed) {
    const Slide slide(arc, friction);
    arc.first = at_once(arc.from, slide.direction(slide.end()));
  }
  for (const std::int32_t slot : {plane.slot, plane.beside}) {
    if (round_edge && slot >= 0) {
      const geometry::Corners& beside = surface.corners(slot);
      const Vector3d out = (beside[0] + beside[1] + beside[2]) / 3.0 - nearest.point;
      arc.first =
          before_face(arc.first, plane.normal, surface.normal(slot), out - edge * edge.dot(out));
    }
  }
  return arc;
}

double face_end(const geometry::Corners& c, const Vector3d& normal, const Vector3d& from,
                const Vector3d& move, double beyond) noexcept {
  double part = 1.0;
  for (int k = 0; k < 3; ++k) {
    const Vector3d edge = c[(k + 1) % 3] - c[k];
    Vector3d out = edge.cross(normal);
    if (out.dot(c[(k + 2) % 3] - c[k]) > 0.0) {
      out = -out;
    }
    const double left = beyond * out.norm() - out.dot(from - c[k]);
    const double rate = out.dot(move);
    if (left <= 0.0) {
      return 1.0;
    }
    if (rate * part > left) {
      part = left / rate;
    }
  }
  return part;
}

}  // namespace haptrial::contact
