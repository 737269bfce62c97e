#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/contact/contact_surface.h"
#include "core/contact/plane_set.h"
#include "core/geometry/mesh/closest_point.h"

namespace haptrial::contact {

/// The way of a sphere round an edge or a corner that it touches, along two tangents of its arc,
/// which stay outside of it. The sphere lies beside `nearest` in the direction `from`, and would
/// lie beside `nearest + along` in another one. Lengths in m.
///
/// With friction it slides down the distance to the goal, at the angle a from `wanted`:
///
///     da/ds = -(depth / distance) sin a        the rest of `along` falls as exp(-s)
///
/// so that tan(a / 2) falls as exp(-s depth / distance).
struct Arc {
  Eigen::Vector3d nearest;  // of the edge to the sphere
  Eigen::Vector3d along;    // the edge, to where the goal is beside it; zero at a corner
  Eigen::Vector3d from;     // a unit vector, as all of these directions
  Eigen::Vector3d wanted;   // straight towards the goal
  Eigen::Vector3d first;  // to be tried first: `wanted`, the friction cone, or where a face begins
  double distance;        // of the sphere's centre from the edge
  double depth;           // of the goal from the edge
  bool rubbed;            // with friction

  /// Point at which the two tangents meet; the second ends there too, on the way to the direction
  /// `to`.
  Eigen::Vector3d corner(const Eigen::Vector3d& to) const noexcept {
    return nearest + 0.5 * slid(to) * along + distance / (1.0 + from.dot(to)) * (from + to);
  }
  Eigen::Vector3d end(const Eigen::Vector3d& to) const noexcept {
    return nearest + slid(to) * along + distance * to;
  }
  /// The part of `along` that is behind the sphere at the direction `to`.
  double slid(const Eigen::Vector3d& to) const noexcept;
  /// The direction across the edge that is nearest to a normal.
  Eigen::Vector3d across(const Eigen::Vector3d& normal) const noexcept;
  /// Whether a direction lies nearer to the goal than where the sphere is.
  bool leads_on(const Eigen::Vector3d& to) const noexcept {
    return to.dot(wanted) > from.dot(wanted) + 1e-12;
  }
};

/// The arc round a surface; none if the sphere touches the triangle's face, or the goal is on the
/// edge or, without friction, behind it.
/// @param plane  the tangent at which a sphere touches its triangle
/// @param at  the sphere's centre [m]
/// @param friction  dynamic; 0: none
/// @param least  moves shorter than this are none [m]
std::optional<Arc> arc_round(const ContactSurface& surface, const ContactPlane& plane,
                             const Eigen::Vector3d& at, const Eigen::Vector3d& goal,
                             double friction, double least) noexcept;

/// The part of a move along a triangle after which the place is beside the triangle, `beyond` over
/// one of its sides; 1 if the move ends before or begins there.
/// @param normal  of the triangle, a unit vector; how high the place lies along it does not matter
/// @param beyond  [m]
double face_end(const geometry::Corners& corners, const Eigen::Vector3d& normal,
                const Eigen::Vector3d& from, const Eigen::Vector3d& move, double beyond) noexcept;

}  // namespace haptrial::contact
