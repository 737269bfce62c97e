#include "core/contact/proxy/arc.h"

#include <Eigen/Geometry>
#include <cmath>

#include "core/geometry/triangle/triangle_distance.h"

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

}  // namespace

Vector3d Arc::across(const Vector3d& normal) const noexcept {
  const double length = along.norm();
  Vector3d to = normal;
  if (length > 0.0) {
    to -= along * (along.dot(normal) / (length * length));
  }
  return to.normalized();
}

std::optional<Arc> arc_round(const ContactSurface& surface, const ContactPlane& plane,
                             const Vector3d& at, const Vector3d& goal, double least) noexcept {
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
  if (!(depth > least) || !(plane.normal.dot(to_goal) > 0.05 * depth)) {
    return std::nullopt;
  }
  const Vector3d wanted = to_goal / depth;
  Vector3d first = wanted;
  for (const std::int32_t slot : {plane.slot, plane.beside}) {
    if (round_edge && slot >= 0) {
      const geometry::Corners& beside = surface.corners(slot);
      const Vector3d out = (beside[0] + beside[1] + beside[2]) / 3.0 - nearest.point;
      first = before_face(first, plane.normal, surface.normal(slot), out - edge * edge.dot(out));
    }
  }
  return Arc{nearest.point, along, plane.normal, wanted, first, plane.level};
}

}  // namespace haptrial::contact
