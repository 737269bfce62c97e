#pragma once

#include <variant>

namespace haptrial::evaluation {

/// Bodies whose contact with a point is known exactly, each in a frame of its own. All lengths are
/// above 0 [m], angles inside (0, π/2) [rad].
struct TruePlane {};  // solid where y < 0
struct TrueSphere {
  double radius;  // about the origin
};
struct TrueCylinder {
  double radius;  // around z, endless
};
struct TrueTorus {
  double radius, tube_radius;  // around z; tube_radius < radius
};
/// A convex edge along z at the origin: faces fall from it by `flank` below the horizontal, solid
/// below both.
struct TrueWedge {
  double flank;
};
/// A concave edge along z at the origin: faces rise from it by `flank`, solid below either.
struct TrueConcaveEdge {
  double flank;
};
/// Solid where y < height sin(2π x / length).
struct TrueWavyPlate {
  double height, length;
};
/// Solid where |x| < width / 2 and |y| < thickness / 2; endless along z.
struct TrueThinPlate {
  double width, thickness;
};
using TrueBody = std::variant<TruePlane, TrueSphere, TrueCylinder, TrueTorus, TrueWedge,
                              TrueConcaveEdge, TrueWavyPlate, TrueThinPlate>;

}  // namespace haptrial::evaluation
