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

/// A cuboid of 12 triangles. @param size  of its sides along x, y and z, each > 0 [m]
Mesh make_box(const Eigen::Vector3d& size);

/// A cylinder along z, or a cone if `top_radius` is 0, or what lies between.
/// @param radius  of the end at -length / 2 [m]  @param top_radius  of the other one, >= 0 [m]
/// @param length  > 0 [m]
/// @param around  >= 3: the mesh has 4 around triangles, a cone 2 around.
Mesh make_frustum(double radius, double top_radius, double length, int around);

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
