#pragma once

#include <Eigen/Core>

#include "core/contact/hull.h"
#include "core/contact/plane_set.h"

namespace haptrial::contact {

/// How far the proxy keeps off: larger than every rounding of a test, and nothing that a hand or a
/// sum of forces could find.
///
/// Coordinates of size M are rounded to 2^-53 M and a test gathers less than 2^-49 M, so a skin of
/// 2^-42 M decides every test on the safe side.
struct Skin {
  double thickness;  // h: of the hull around each triangle that is never entered [m]
  double rest() const noexcept { return 2.0 * thickness; }  // how far the proxy stops before it

  /// @param magnitude  M: of the mesh's and of the path's coordinates [m]
  static Skin of(double magnitude) noexcept { return {0x1p-42 * magnitude}; }
};

/// The part of a tick's motion that is looked at.
struct Sweep {
  Eigen::Vector3d from;  // [m]
  Eigen::Vector3d move;  // [m]
  double radius;         // of the proxy; 0: a point [m]
  Skin skin;
};

struct SweepHit {
  double t;            // where the proxy stops, as a part of the move
  ContactPlane plane;  // what stops it
};

/// Whether a point meets a triangle before the part `end` of its move. Its hull is taken h thicker
/// and h/2 wider, and the point never enters it. `hit` is written where it is met.
/// @param apart  receives the direction of a plane between the move and the triangle, a unit
///     vector; unchanged if the triangle is met or no plane of the hull keeps them apart
bool sweep_point(const Sweep& sweep, const Hull& hull, double end, SweepHit& hit,
                 Eigen::Vector3d& apart) noexcept;

/// The same for a sphere: the distance from its centre to a triangle is a convex function of t, so
/// Newton's steps from the left never pass its first crossing of r + h.
/// @param normal  of the triangle, a unit vector
/// @param apart  receives the direction from the triangle's nearest point to where the sphere is at
///     the start
bool sweep_sphere(const Sweep& sweep, const geometry::Corners& corners,
                  const Eigen::Vector3d& normal, const Hull& hull, double end, SweepHit& hit,
                  Eigen::Vector3d& apart) noexcept;

}  // namespace haptrial::contact
