#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "core/base/instruction_set.h"
#include "core/geometry/mesh/mesh.h"

namespace haptrial::geometry {

/// The triangles that close an open mesh: with them every edge is run along as often one way as the
/// other, whatever the mesh is like, so that the winding number of both together is a whole number
/// everywhere. Each loop of the boundary gets a fan of triangles around its own middle.
struct BoundaryCone {
  struct Fan {
    std::size_t first;  // of its triangles in the mesh; the next fan's follow them
    std::size_t count;
    Eigen::Vector3d middle;  // [m]
    double radius;           // of a ball around the middle that holds the fan [m]
    double area;             // [m²]
  };
  Mesh mesh;
  std::vector<Fan> fans;

  /// How often a fan winds around a point at most, by its area and distance; infinite within its
  /// ball. A surface of area A, seen from a distance of d or more, fills at most A/d² of the 4π.
  static double most_winding(const Fan& fan, double distance_to_middle);
};
BoundaryCone boundary_cone(const Mesh& mesh);

/// How often triangles wind around a point: the sum of the solid angles that they fill, over 4π.
/// Source: van Oosterom and Strackee 1983.
double winding_sum(const Mesh& mesh, const Eigen::Vector3d& point);

/// Points side by side, for kernels that take them at once.
inline constexpr int kPointLanes = 16;
struct PointLanes {
  alignas(64) std::array<float, kPointLanes> x, y, z;
};

/// The same for many points to about 1e-5. The tangents of half the angles are multiplied as
/// complex numbers, so that one arc tangent does for all of a point.
/// @param corners  three after each other are a triangle; near the origin, of size 1 or so
void winding_sums(std::span<const Eigen::Vector3f> corners, const PointLanes& points,
                  std::array<float, kPointLanes>& sums);
/// The same with another kernel: the same bits. @throws std::invalid_argument where it cannot run.
void winding_sums(std::span<const Eigen::Vector3f> corners, const PointLanes& points,
                  std::array<float, kPointLanes>& sums, InstructionSet set);

}  // namespace haptrial::geometry
