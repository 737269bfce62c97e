#pragma once

#include <cstdint>

#include "core/geometry/mesh/mesh.h"

namespace haptrial::geometry {

/// Closed, oriented meshes without self-intersections, for tests, studies and trying things out.
/// All are centred on the origin. Bad arguments give std::invalid_argument.

/// A geodesic sphere: each face of an icosahedron in frequency² triangles, pushed out to `radius`.
/// @param radius  > 0 [m]
/// @param frequency  1 .. 5,000: the mesh has 20 frequency² triangles.
Mesh make_sphere(double radius, int frequency);

/// A torus around z.
/// @param radius  of the circle in its middle [m]
/// @param tube_radius  < radius [m]
/// @param around, across  >= 3: the mesh has 2 around across triangles.
Mesh make_torus(double radius, double tube_radius, int around, int across);

/// A spur gear around z with trapezoidal teeth and a bore: genus 1.
struct GearShape {
  int teeth{31};             // >= 3: the gear has 32 teeth triangles
  double tip_radius{0.05};   // [m]
  double root_radius{0.04};  // < tip_radius [m]
  double bore_radius{0.02};  // < root_radius [m]
  double thickness{0.02};    // [m]
};
Mesh make_gear(const GearShape& shape = {});  // 992 triangles by default

/// A rough solid without a symmetry: an ellipsoid with furrows and bumps at every scale, the sum of
/// seeded waves. Every ray from the origin leaves it once.
/// @param length  of the ellipsoid's long axis [m]
/// @param frequency  as for make_sphere: 100 gives 200,000 triangles.
Mesh make_rough_solid(double length, int frequency, std::uint64_t seed);

}  // namespace haptrial::geometry
